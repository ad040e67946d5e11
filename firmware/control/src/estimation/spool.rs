//! Model of a spool and its solenoid.

use hitch_quantities::fixed::{Divisor, behind};
use hitch_quantities::units::MilliAmp;

/// Model of solenoid and spool: hysteresis (play) and first-order lag, as current on the rising branch.
#[derive(Clone, Copy, Debug, Default)]
pub struct Spool {
    play: MilliAmp,
    microampere: i32,
}

impl Spool {
    /// One step with the current of the coil; the spool position as an equivalent current.
    pub fn follow(&mut self, coil: MilliAmp, hysteresis: MilliAmp, lag: Divisor) -> MilliAmp {
        /// Below this current a spool with its coil off is closed: half of the smallest threshold.
        const CLOSED_MICROAMPERE: i32 = 300_000;
        if coil == MilliAmp::ZERO && self.microampere < CLOSED_MICROAMPERE {
            return MilliAmp::ZERO;
        }
        self.play = self.play.limited(coil, coil + hysteresis);
        let goal = self.play.0.saturating_mul(1000);
        self.microampere = behind(self.microampere, goal, lag);
        MilliAmp(Divisor::THOUSAND.divide(self.microampere))
    }
}
