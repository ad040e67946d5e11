//! The pressure compensator (PC valve), or the controller of a load-sensing pump.

/// Three-way pressure compensator.
///
/// While lifting, it bypasses pump flow such that the pump pressure is `margin` above the cylinder line downstream of
/// the check valve. With the lift valve closed, the whole flow goes to tank at that margin (paper, Table 4 and section
/// 4.2.3: 4 bar). The controller of a load-sensing pump keeps the same margin by the displacement of the pump.
#[derive(Debug, Clone, PartialEq)]
pub struct Compensator {
    /// Spring margin, Pa.
    pub margin_pa: f64,
}

impl Compensator {
    /// Pressure of a pump of fixed displacement with the lift valve closed, Pa.
    #[inline]
    #[must_use]
    pub fn idle_pressure_pa(&self) -> f64 {
        self.margin_pa
    }

    /// Pump pressure while lifting against `load_pressure_pa`, Pa.
    #[inline]
    #[must_use]
    pub fn lifting_pressure_pa(&self, load_pressure_pa: f64) -> f64 {
        load_pressure_pa + self.margin_pa
    }
}
