//! A model: the constants of every component and the list of added effects.

use std::sync::Arc;

use crate::components::linkage::Linkage;
use crate::components::linkage_error::LinkageError;
use crate::constants::{Constants, Dynamics};
use crate::hooks::effect::{AddedEffect, Effect};

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
        let linkage = Linkage::new(&constants.linkage, constants.cylinder.stroke_m)?;
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
            && constants.cylinder.stroke_m == self.constants.cylinder.stroke_m;
        let linkage = match same_linkage {
            true => Arc::clone(&self.linkage),
            false => Arc::new(Linkage::new(
                &constants.linkage,
                constants.cylinder.stroke_m,
            )?),
        };
        Ok(Self {
            spool_lag_s: spool_lag_s(&constants),
            constants: Arc::new(constants),
            linkage,
            ..self.clone()
        })
    }

    /// The constants.
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

    /// The linkage.
    #[must_use]
    pub fn linkage(&self) -> &Arc<Linkage> {
        &self.linkage
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
        let constants = Constants {
            dynamics: Dynamics::Steady,
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

/// Lag of the spools of a plant with these constants, s.
fn spool_lag_s(constants: &Constants) -> f64 {
    match constants.dynamics {
        Dynamics::Steady => 0.0,
        Dynamics::Dynamic => constants.spool_time_constant_s,
    }
}
