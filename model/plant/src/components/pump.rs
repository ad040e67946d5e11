//! The pump: fixed displacement, driven at constant speed.

/// Fixed-displacement pump.
///
/// `Q = Q_theoretical * eta_v` (paper, Table 4: 54.5 l/min, 88 %, 1500 rev/min). Pressure-dependent slip is an effect.
#[derive(Debug, Clone, PartialEq)]
pub struct Pump {
    /// Displacement times speed, m3/s.
    pub theoretical_flow_m3_s: f64,
    /// Volumetric efficiency, 0 to 1.
    pub volumetric_efficiency: f64,
}

impl Pump {
    /// Net delivery, m3/s.
    #[must_use]
    pub fn flow_m3_s(&self) -> f64 {
        self.theoretical_flow_m3_s * self.volumetric_efficiency
    }
}
