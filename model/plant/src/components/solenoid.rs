//! The solenoids of both valves.

/// Electrical constants of a solenoid. The plant starts at the current; a closed loop with a driver also has the coil.
#[derive(Debug, Clone, PartialEq)]
pub struct Solenoid {
    /// Resistance at 20 C with wiring and driver, ohm.
    pub resistance_ohm: f64,
    /// Inductance, H.
    pub inductance_h: f64,
}

impl Default for Solenoid {
    /// A 12 V coil for 3.5 A.
    fn default() -> Self {
        Self {
            resistance_ohm: 2.3,
            inductance_h: 12e-3,
        }
    }
}
