//! Compensates the hysteresis of a valve while a move decelerates.

use hitch_quantities::units::{MicrometrePerSecond, MilliAmp};

/// Current reduction on the falling branch of a hysteresis. It starts when a move decelerates and ends with the move.
#[derive(Clone, Copy, Debug, Default)]
pub struct HysteresisCompensation {
    peak_speed: MicrometrePerSecond,
    compensation: MilliAmp,
}

impl HysteresisCompensation {
    /// True once the move decelerates.
    #[must_use]
    pub fn is_active(&self) -> bool {
        self.compensation > MilliAmp::ZERO
    }

    /// One step at the demanded `speed`: the current reduction for the same flow. `deceleration`: see
    /// [`super::travel_distances::TravelDistances`].
    pub fn step(
        &mut self,
        speed: MicrometrePerSecond,
        hysteresis: MilliAmp,
        deceleration: MicrometrePerSecond,
    ) -> MilliAmp {
        /// The reduction is a ramp of so many steps: a step of current would excite the load.
        const RAMP_STEPS: i32 = 16;
        if speed <= MicrometrePerSecond::ZERO {
            *self = Self::default();
            return MilliAmp::ZERO;
        }
        self.peak_speed = self.peak_speed.max(speed);
        if self.peak_speed - speed > deceleration {
            let step = MilliAmp((hysteresis.0 / RAMP_STEPS).max(1));
            self.compensation = (self.compensation + step).min(hysteresis);
        }
        self.compensation
    }
}
