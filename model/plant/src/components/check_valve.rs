//! The check valve between lift valve and cylinder.

/// Check valve with a constant cracking pressure and no reverse flow (paper, Table 4 and equation 7: 2.5 bar).
#[derive(Debug, Clone, PartialEq)]
pub struct CheckValve {
    /// Cracking pressure, Pa.
    pub cracking_pressure_pa: f64,
}

impl CheckValve {
    /// Drop across the lift orifice out of that from pump to cylinder, Pa; zero until the check valve opens.
    #[inline]
    #[must_use]
    pub fn remaining_drop_pa(&self, pump_pressure_pa: f64, cylinder_pressure_pa: f64) -> f64 {
        (pump_pressure_pa - cylinder_pressure_pa - self.cracking_pressure_pa).max(0.0)
    }
}
