//! Rate law: the rocker turns at the rate that a button demands while it is held.
//!
//! The demanded rate is ramped and converted to piston speed by the linkage. Before the ends of travel it is limited by
//! the speed profile of the position law. The bias of the motion observer corrects the error of the valve map, so the
//! speed does not depend on the load. A slow integral removes the remaining error of the hysteresis once the ramp has
//! ended.

use hitch_quantities::Calibration;
use hitch_quantities::calibration::design_parameters::RateParameters;
use hitch_quantities::fixed::Divisor;
use hitch_quantities::units::{Micrometre, MicrometrePerSecond, MilliDegree, MilliDegreePerSecond};

use super::position::approach_speed;
use crate::estimation::motion_observer::MotionObserver;
use crate::valve::phase::{Demand, Direction};

/// The rate controller.
#[derive(Clone, Copy, Debug, Default)]
pub struct RateControl {
    /// Ramped rate, 1e-6 degree/s: the resolution of slow ramps.
    rate_micro: i32,
    /// Integral trim, nm/s: reduces the demanded speed in the direction of the move.
    trim_nm_per_s: i32,
}

impl RateControl {
    /// One step towards `request` (zero: released), not beyond `upper_limit`.
    pub fn demand(
        &mut self,
        request: MilliDegreePerSecond,
        angle: MilliDegree,
        upper_limit: MilliDegree,
        motion: &MotionObserver,
        calibration: &Calibration,
    ) -> Demand {
        let parameters = &calibration.rate;
        let goal = request
            .limited(-parameters.rate_limit, parameters.rate_limit)
            .0
            .saturating_mul(1000);
        // 1 deg/s2 is 1000 udeg/s a millisecond.
        let step = parameters.rate_slope.0;
        self.rate_micro = goal
            .max(self.rate_micro.saturating_sub(step))
            .min(self.rate_micro.saturating_add(step));
        let rate = MilliDegreePerSecond(Divisor::THOUSAND.divide(self.rate_micro));
        let direction = Direction::of(rate.0);
        let wanted = calibration.linkage.piston_speed(angle, rate).magnitude();
        let allowed = speed_before_limit(direction, upper_limit, motion, calibration);
        if self.rate_micro == goal && wanted < allowed {
            self.integrate(
                MicrometrePerSecond(direction.sign(motion.speed().0)) - wanted,
                parameters,
            );
        }
        Demand {
            direction,
            speed: wanted.min(allowed),
            acceleration: calibration.position.lift_acceleration,
        }
    }

    fn integrate(&mut self, excess: MicrometrePerSecond, parameters: &RateParameters) {
        let limit = parameters.trim_limit.0.saturating_mul(1000);
        let step = parameters
            .trim_time
            .divisor()
            .divide(excess.0.saturating_mul(1000));
        self.trim_nm_per_s = self
            .trim_nm_per_s
            .saturating_add(step)
            .max(limit.saturating_neg())
            .min(limit);
    }

    /// Integral trim: reduces the demanded speed in the direction of the move.
    #[must_use]
    pub fn trim(&self) -> MicrometrePerSecond {
        MicrometrePerSecond(Divisor::THOUSAND.divide(self.trim_nm_per_s))
    }
}

/// Largest speed from which the hitch stops before the end of its travel.
fn speed_before_limit(
    direction: Direction,
    upper_limit: MilliDegree,
    motion: &MotionObserver,
    calibration: &Calibration,
) -> MicrometrePerSecond {
    let position = &calibration.position;
    let (limit, deceleration) = match direction {
        Direction::Lift => (upper_limit, position.lift_deceleration),
        Direction::Lower => (position.lower_limit, position.lower_deceleration),
    };
    let remaining = calibration.linkage.travel(limit)
        - motion
            .stop_prediction(&calibration.hydraulics)
            .predicted_stop();
    let ahead = Micrometre(direction.sign(remaining.0));
    if ahead <= position.stop_band {
        MicrometrePerSecond::ZERO
    } else {
        approach_speed(ahead, deceleration, position.approach_gain)
    }
}
