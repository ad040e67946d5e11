//! The masses of hitch and load.

use crate::units::GRAVITY_M_S2;

/// The moving masses (docs/plant.md: 30 kg of links and frame at the hitch point, 20 kg at the piston).
#[derive(Debug, Clone, PartialEq)]
pub struct Masses {
    /// Dead weight of links and frame, reduced to the hitch point, kg.
    pub dead_weight_kg: f64,
    /// Piston, rod and rocker, reduced to the piston, kg; used by the dynamic plant.
    pub piston_kg: f64,
}

impl Masses {
    /// Static piston force, N, for a load in kg at a transmission `dh/dx` (virtual work; paper, equations 1 to 4).
    #[inline]
    #[must_use]
    pub fn weight_force_n(&self, load_kg: f64, dh_dx: f64) -> f64 {
        (load_kg + self.dead_weight_kg) * GRAVITY_M_S2 * dh_dx
    }

    /// Share of the load in the weight; the rest is dead weight.
    #[inline]
    #[must_use]
    pub fn load_share(&self, load_kg: f64) -> f64 {
        load_kg / (load_kg + self.dead_weight_kg)
    }

    /// Inertia at the piston, kg.
    #[inline]
    #[must_use]
    pub fn inertia_kg(&self, load_kg: f64, dh_dx: f64) -> f64 {
        (load_kg + self.dead_weight_kg) * dh_dx * dh_dx + self.piston_kg
    }

    /// Half the derivative of the inertia over piston travel, kg/m: the `M' v2 / 2` term of Lagrange's equation.
    #[inline]
    #[must_use]
    pub fn half_inertia_slope_kg_m(&self, load_kg: f64, dh_dx: f64, d2h_dx2_1_m: f64) -> f64 {
        (load_kg + self.dead_weight_kg) * dh_dx * d2h_dx2_1_m
    }
}
