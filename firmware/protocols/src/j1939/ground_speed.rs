//! Ground speed: whether the machine is too fast for remote control (ISO 11783-7, wheel-based and ground-based speed).
//!
//! Each message above the limit counts, from any source: a node can end remote control with it, but a slow speed does
//! not outweigh a fast one.

use hitch_quantities::units::MicrometrePerSecond;

use super::machine_speed;
use super::time::since_ms;

/// The speed is sent every 100 ms; a fast one counts for so long, ms.
const HELD_MS: u32 = 300;
/// Micrometres in a millimetre.
const UM_PER_MM: i32 = 1_000;

/// Monitors the ground speed.
#[derive(Clone, Copy, Debug, Default)]
pub struct GroundSpeed {
    /// When a speed above the limit was received.
    exceeded_ms: Option<u32>,
}

impl GroundSpeed {
    /// A message of either group was received.
    pub fn receive(&mut self, bytes: &[u8; 8], limit: MicrometrePerSecond, now_ms: u32) {
        let speed = machine_speed::speed(bytes);
        if speed.is_some_and(|speed| MicrometrePerSecond(speed.0 * UM_PER_MM) > limit) {
            self.exceeded_ms = Some(now_ms);
        }
    }

    /// One step; true while the speed is above the limit. Called at least once a day, because the milliseconds wrap.
    pub fn is_exceeded(&mut self, now_ms: u32) -> bool {
        self.exceeded_ms = self
            .exceeded_ms
            .filter(|&at_ms| since_ms(at_ms, now_ms) <= HELD_MS);
        self.exceeded_ms.is_some()
    }
}
