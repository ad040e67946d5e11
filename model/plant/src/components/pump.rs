//! The pump, driven at constant speed: of fixed displacement, or load-sensing.

/// How the pump's delivery is controlled.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PumpKind {
    /// Fixed displacement; a bypass compensator returns the flow that the lift valve does not take to tank.
    FixedDisplacement,
    /// Variable displacement; the controller of the pump delivers the flow that the lift valve takes.
    LoadSensing,
}

/// The pump.
///
/// Either kind delivers at most `Q = Q_theoretical * eta_v` (paper, Table 4: 54.5 l/min, 88 %, 1500 rev/min).
/// Pressure-dependent slip is an effect.
#[derive(Debug, Clone, PartialEq)]
pub struct Pump {
    /// Control of its delivery.
    pub kind: PumpKind,
    /// Largest displacement times speed, m3/s.
    pub theoretical_flow_m3_s: f64,
    /// Volumetric efficiency, 0 to 1.
    pub volumetric_efficiency: f64,
    /// Pump pressure of a load-sensing pump with the lift valve closed, Pa; zero for the other kind.
    pub standby_pressure_pa: f64,
    /// Time constant of the pressure of a load-sensing pump, s; used by the dynamic plant, zero for the other kind.
    pub response_time_s: f64,
}

impl Pump {
    /// Largest net delivery, m3/s.
    #[inline]
    #[must_use]
    pub fn flow_m3_s(&self) -> f64 {
        self.theoretical_flow_m3_s * self.volumetric_efficiency
    }
}
