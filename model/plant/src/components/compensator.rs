//! The pressure compensator (PC valve).

/// Three-way pressure compensator.
///
/// While lifting it dumps just so much of the pump's flow that the pump pressure stands `margin` above the cylinder
/// line behind the check valve; with the lift valve shut the whole flow goes to tank at that margin
/// (paper, Table 4 and section 4.2.3: 4 bar).
#[derive(Debug, Clone, PartialEq)]
pub struct Compensator {
    /// Spring margin, Pa.
    pub margin_pa: f64,
}

impl Compensator {
    /// Pump pressure with the lift valve shut, Pa.
    #[must_use]
    pub fn idle_pressure_pa(&self) -> f64 {
        self.margin_pa
    }

    /// Pump pressure that it sets while lifting against `load_pressure_pa`, Pa.
    #[must_use]
    pub fn lifting_pressure_pa(&self, load_pressure_pa: f64) -> f64 {
        load_pressure_pa + self.margin_pa
    }
}
