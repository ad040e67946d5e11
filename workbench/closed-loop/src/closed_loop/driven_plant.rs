//! A plant driven through its two coils by duty cycles.

use hitch_plant::{Currents, HitchRig, Model, Plant, Reading, Rig, Solenoid};

use super::coil::Coil;
use super::instruments::SUPPLY_V;

/// The controller's step, s.
pub const STEP_S: f64 = 1e-3;

/// The two coils of a hitch.
#[derive(Debug, Clone, Copy)]
struct CoilPair {
    lift: Coil,
    lower: Coil,
}

impl CoilPair {
    /// Cold and currentless.
    const fn of(solenoid: &Solenoid) -> Self {
        Self {
            lift: Coil::of(solenoid),
            lower: Coil::of(solenoid),
        }
    }

    /// One millisecond at these duty cycles; returns the mean currents.
    fn step(&mut self, [lift, lower]: [f64; 2]) -> Currents {
        Currents {
            lift_a: self.lift.step(lift, SUPPLY_V),
            lower_a: self.lower.step(lower, SUPPLY_V),
        }
    }
}

/// Plant and coils.
pub struct DrivenPlant<'m> {
    plant: Plant<'m>,
    coils: CoilPair,
    currents: Currents,
}

impl<'m> DrivenPlant<'m> {
    /// A hitch at rest at `start_angle_deg`, without current.
    #[must_use]
    pub fn at_rest(
        model: &'m Model,
        load_kg: f64,
        oil_temperature_c: f64,
        start_angle_deg: f64,
    ) -> Self {
        let rig = Rig::Hitch(HitchRig {
            load_kg,
            start_angle_rad: start_angle_deg.to_radians(),
        });
        Self {
            plant: Plant::new(model, rig, oil_temperature_c, Currents::default()),
            coils: CoilPair::of(&model.constants().solenoid),
            currents: Currents::default(),
        }
    }

    /// One millisecond at these duty cycles of lift and lowering coil; `wire` can modify the coil voltages (wiring
    /// faults).
    pub fn step(&mut self, shares: [f64; 2], wire: impl FnOnce(&mut Currents)) {
        self.currents = self.coils.step(shares);
        wire(&mut self.currents);
        self.plant.step(self.currents, STEP_S);
    }

    /// Changes the load of the hitch, kg.
    pub fn set_load_kg(&mut self, load_kg: f64) {
        self.plant.set_load_kg(load_kg);
    }

    /// Changes the oil temperature, C.
    pub fn set_oil_temperature_c(&mut self, oil_temperature_c: f64) {
        self.plant.set_oil_temperature_c(oil_temperature_c);
    }

    /// Currents in the coils.
    #[must_use]
    pub const fn currents(&self) -> Currents {
        self.currents
    }

    /// The measurable quantities.
    #[must_use]
    pub fn reading(&self) -> Reading {
        self.plant.reading()
    }

    /// Rocker angle, degree.
    #[must_use]
    pub fn angle_deg(&self) -> f64 {
        self.plant.rocker_angle_rad().to_degrees()
    }
}
