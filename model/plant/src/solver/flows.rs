//! Flows of the hydraulic circuit at one instant.

/// Flows and pump pressure of the circuit.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Flows {
    /// Through the lift valve into the cylinder, m3/s.
    pub lift_m3_s: f64,
    /// Through the lowering valve to tank, m3/s.
    pub lower_m3_s: f64,
    /// Out of the cylinder past the valves, m3/s.
    pub leakage_m3_s: f64,
    /// Pump pressure, Pa.
    pub pump_pressure_pa: f64,
}

impl Flows {
    /// Flow at the flow meter in the cylinder line, m3/s, positive into the cylinder.
    #[inline(always)]
    #[must_use]
    pub fn metered_m3_s(&self) -> f64 {
        self.lift_m3_s - self.lower_m3_s
    }

    /// Net flow into the cylinder, m3/s.
    #[inline(always)]
    #[must_use]
    pub fn net_m3_s(&self) -> f64 {
        self.metered_m3_s() - self.leakage_m3_s
    }
}
