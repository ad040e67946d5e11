//! A model: the constants of every component and the list of added effects.

use std::sync::Arc;

use crate::components::linkage::{Joints, Linkage};
use crate::components::linkage_error::LinkageError;
use crate::components::linkage_sketch::sketched;
use crate::components::usual_loads::UsualLoads;
use crate::constants::{Constants, Dynamics};
use crate::hooks::effect::{AddedEffect, Effect};
use crate::units::GRAVITY_M_S2;

/// Smallest usual load as a share of the largest possible one.
const LIGHT_SHARE: f64 = 0.03;

/// A model of the hitch: constants, the linkage solved from them, and the added effects.
#[derive(Debug, Clone)]
pub struct Model {
    /// Name, for reports.
    pub name: String,
    /// Effects added to the paper's plant, in the order in which they were added.
    pub effects: Vec<AddedEffect>,
    /// User-defined effects from its file, whether they are active or not.
    pub terms: Vec<&'static dyn Effect>,
    constants: Arc<Constants>,
    linkage: Arc<Linkage>,
    spool_lag_s: f64,
}

impl Model {
    /// A model without effects.
    ///
    /// # Errors
    /// [`LinkageError`] when the dimensions make no linkage.
    pub fn new(name: impl Into<String>, constants: Constants) -> Result<Self, LinkageError> {
        let linkage = linkage_of(&constants)?;
        Ok(Self {
            name: name.into(),
            effects: Vec::new(),
            terms: Vec::new(),
            spool_lag_s: spool_lag_s(&constants),
            constants: Arc::new(constants),
            linkage: Arc::new(linkage),
        })
    }

    /// The same model with other constants.
    ///
    /// # Errors
    /// [`LinkageError`] when the dimensions make no linkage.
    pub fn with_constants(&self, constants: Constants) -> Result<Self, LinkageError> {
        let same_linkage = constants.linkage == self.constants.linkage
            && constants.linkage_table == self.constants.linkage_table
            && constants.cylinder.stroke_m == self.constants.cylinder.stroke_m;
        let linkage = if same_linkage {
            Arc::clone(&self.linkage)
        } else {
            Arc::new(linkage_of(&constants)?)
        };
        Ok(Self {
            spool_lag_s: spool_lag_s(&constants),
            constants: Arc::new(constants),
            linkage,
            ..self.clone()
        })
    }

    /// The constants.
    #[inline]
    #[must_use]
    pub fn constants(&self) -> &Constants {
        &self.constants
    }

    /// Shared ownership of the constants.
    #[must_use]
    pub fn shared_constants(&self) -> &Arc<Constants> {
        &self.constants
    }

    /// First-order lag of either spool, s.
    #[must_use]
    pub fn spool_lag_s(&self) -> f64 {
        self.spool_lag_s
    }

    /// Time constant of the pump pressure, s; zero in a quasi-static plant.
    #[must_use]
    pub fn pump_response_s(&self) -> f64 {
        match self.constants.dynamics {
            Dynamics::Steady => 0.0,
            Dynamics::Dynamic => self.constants.pump.response_time_s,
        }
    }

    /// The linkage.
    #[inline]
    #[must_use]
    pub fn linkage(&self) -> &Arc<Linkage> {
        &self.linkage
    }

    /// The joints of the linkage at a rocker angle, rad; a sketch with the right height if it is measured.
    ///
    /// # Errors
    /// [`LinkageError`] if the dimensions cannot be assembled at this angle.
    pub fn joints(&self, rocker_angle_rad: f64) -> Result<Joints, LinkageError> {
        match self.constants.linkage_table {
            Some(_) => Ok(sketched(&self.linkage, rocker_angle_rad)),
            None => self.constants.linkage.joints(rocker_angle_rad),
        }
    }

    /// Three usual loads, kg: those of the constants; where they are zero, 3, 9 and 15 % of the load that the relief valve just permits in the middle of the
    /// stroke, with the first rounded to one digit. The paper's rig, whose loads are 50, 150 and 250 kg, sets the shares.
    #[must_use]
    pub fn usual_loads_kg(&self) -> [f64; 3] {
        let constants = &self.constants;
        let force_n = constants.relief_valve.set_pressure_pa * constants.cylinder.area_m2();
        let middle_m = 0.5 * constants.cylinder.stroke_m;
        let most_kg = force_n / (self.linkage.dh_dx(middle_m) * GRAVITY_M_S2);
        let light_kg = LIGHT_SHARE * most_kg;
        let digit = 10f64.powf(light_kg.log10().floor());
        let light_kg = (light_kg / digit).round() * digit;
        let UsualLoads {
            light_kg: light,
            usual_kg: usual,
            heavy_kg: heavy,
        } = constants.usual_loads;
        let stated_or = |stated_kg: f64, factor: f64| {
            if stated_kg > 0.0 {
                stated_kg
            } else {
                factor * light_kg
            }
        };
        [
            stated_or(light, 1.0),
            stated_or(usual, 3.0),
            stated_or(heavy, 5.0),
        ]
    }

    /// The same model with other effects.
    #[must_use]
    pub fn with_effects(&self, effects: Vec<AddedEffect>) -> Self {
        Self {
            effects,
            ..self.clone()
        }
    }

    /// The same model with stiff oil and no inertia; the lag of its spools is unchanged.
    #[must_use]
    pub fn quasi_static(&self) -> Self {
        self.with_dynamics(Dynamics::Steady)
    }

    /// The same model with or without dynamics; all its constants are kept.
    #[must_use]
    pub fn with_dynamics(&self, dynamics: Dynamics) -> Self {
        let constants = Constants {
            dynamics,
            ..(*self.constants).clone()
        };
        Self {
            constants: Arc::new(constants),
            ..self.clone()
        }
    }

    /// The same model with other user-defined terms.
    #[must_use]
    pub fn with_terms(&self, terms: Vec<&'static dyn Effect>) -> Self {
        Self {
            terms,
            ..self.clone()
        }
    }
}

/// The linkage of a plant: measured, or solved from its dimensions.
fn linkage_of(constants: &Constants) -> Result<Linkage, LinkageError> {
    let stroke_m = constants.cylinder.stroke_m;
    match &constants.linkage_table {
        Some(table) => Linkage::tabulated(table, stroke_m),
        None => Linkage::new(&constants.linkage, stroke_m),
    }
}

/// Lag of the spools of a plant with these constants, s.
fn spool_lag_s(constants: &Constants) -> f64 {
    match constants.dynamics {
        Dynamics::Steady => 0.0,
        Dynamics::Dynamic => constants.spool_time_constant_s,
    }
}
