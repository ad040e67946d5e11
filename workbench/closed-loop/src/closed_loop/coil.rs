//! A solenoid with its driver: from duty cycle to current.
//!
//! ```text
//! L i' = d V - (1 - d) Vf - R i      i >= 0
//! ```
//!
//! The driver switches at 16 kHz, and the current freewheels through a diode in the off time. The remaining ripple is
//! 20 mA. It is not visible to samples in the middle of a pulse, so the model computes the mean over a pulse.

use hitch_plant::Solenoid;

/// A coil at the common supply.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coil {
    /// Resistance with wiring and driver, ohm.
    pub resistance_ohm: f64,
    /// Inductance, H.
    pub inductance_h: f64,
    /// Current, A.
    pub current_a: f64,
}

/// Voltage drop of the freewheeling diode, V.
const DIODE_V: f64 = 0.7;
/// Steps of the timer in one pulse: 84 MHz at 16 kHz.
const PWM_STEPS: f64 = 5_250.0;
/// Integration steps in a millisecond.
const PIECES: u32 = 8;

impl Coil {
    /// A cold, currentless coil.
    #[must_use]
    pub const fn of(solenoid: &Solenoid) -> Self {
        Self {
            resistance_ohm: solenoid.resistance_ohm,
            inductance_h: solenoid.inductance_h,
            current_a: 0.0,
        }
    }

    /// One millisecond at duty cycle `duty` of `supply_v`; returns the mean current, A.
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
