//! Time until the implement is in work.

use hitch_quantities::units::{Micrometre, MicrometrePerSecond, Millisecond};

use super::Control;
use crate::motion::position::approach_speed;
use crate::motion::time_until_work::Lowering;
use crate::valve::phase::{Direction, Phase};

impl Control {
    /// Time until the present move to `target` is in work. `None` if it is not lowering, or not as far as that.
    pub(super) fn time_until_work(
        &self,
        target: Micrometre,
        lower_speed: MicrometrePerSecond,
    ) -> Option<Millisecond> {
        let calibration = &self.calibration;
        let Phase::Moving {
            direction: Direction::Lower,
            speed,
        } = self.phase
        else {
            return None;
        };
        if self.in_work.now() != Some(false) {
            return None;
        }
        let position = &calibration.position;
        // The set point of quick engagement is on its way to the lower limit.
        let target = if self.reference.engages() {
            target.min(calibration.linkage.travel(position.lower_limit))
        } else {
            target
        };
        let threshold = calibration.linkage.travel(calibration.work.angle);
        if target > threshold {
            return None;
        }
        let deceleration = self.scale.ramp_at_present(position.lower_deceleration);
        let passing = approach_speed(threshold - target, deceleration, position.approach_gain);
        let hydraulics = &calibration.hydraulics;
        let lowering = Lowering {
            distance: self.motion.position() - threshold,
            lag_distance: -self.motion.stop_prediction(hydraulics).lag_distance,
            lag: self.motion.lowering_lag(hydraulics),
            demanded: speed,
            largest: lower_speed.min(self.available),
            passing: passing.max(position.creep_speed),
            acceleration: self.scale.ramp_at_present(position.lower_acceleration),
            deceleration,
        };
        Some(lowering.time())
    }
}
