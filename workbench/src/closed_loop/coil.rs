//! A solenoid and its driver: from the share of the supply that the controller asks for to a current.
//!
//! ```text
//! L i' = d V - (1 - d) Vf - R i      i >= 0
//! ```
//!
//! The driver switches at 16 kHz, and the current freewheels through a diode when it is off: what is left of the
//! switching is a ripple of 20 mA that sampling in the middle of a pulse doesn't see, so the mean over a pulse will do.

/// Supply and what is the same for every coil.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coil {
    /// Resistance with wiring and driver, ohm.
    pub resistance_ohm: f64,
    /// Inductance, H.
    pub inductance_h: f64,
    /// Current, A.
    pub current_a: f64,
}

/// Drop over the freewheeling diode, V.
const DIODE_V: f64 = 0.7;
/// Steps of the timer in one pulse: 84 MHz at 16 kHz.
const PWM_STEPS: f64 = 5_250.0;
/// Pieces into which a millisecond is cut.
const PIECES: u32 = 8;

impl Coil {
    /// A cold coil of the rig without current.
    #[must_use]
    pub fn of_the_rig() -> Self {
        Self {
            resistance_ohm: 2.3,
            inductance_h: 0.012,
            current_a: 0.0,
        }
    }

    /// One millisecond with a share `duty` of `supply_v`; the mean current, A.
    pub fn step(&mut self, duty: f64, supply_v: f64) -> f64 {
        let duty = (duty.clamp(0.0, 1.0) * PWM_STEPS).round() / PWM_STEPS;
        let rest_a = (duty * supply_v - (1.0 - duty) * DIODE_V) / self.resistance_ohm;
        let piece_s = 1e-3 / f64::from(PIECES);
        let keep = (-piece_s * self.resistance_ohm / self.inductance_h).exp();
        let mut sum_a = 0.0;
        for _ in 0..PIECES {
            let before_a = self.current_a;
            self.current_a = (rest_a + (before_a - rest_a) * keep).max(0.0);
            sum_a += 0.5 * (before_a + self.current_a);
        }
        sum_a / f64::from(PIECES)
    }
}
