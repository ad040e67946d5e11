//! The relief valve at the pump.

/// Ideal relief valve: passes any excess flow at its set pressure (paper, Table 4: 154 bar).
#[derive(Debug, Clone, PartialEq)]
pub struct ReliefValve {
    /// Set pressure above tank, Pa.
    pub set_pressure_pa: f64,
}

impl ReliefValve {
    /// Pump pressure, Pa, limited to the set pressure.
    #[inline]
    #[must_use]
    pub fn limit_pa(&self, wanted_pa: f64) -> f64 {
        wanted_pa.min(self.set_pressure_pa)
    }
}
