//! Rate control: the rocker turns at the speed that a button asks for, as long as it is held.
//!
//! The asked rate is ramped, turned into piston speed by the linkage, and slowed down before the ends of
//! travel with the same profile as position control. The motion estimate's bias corrects what the
//! valve map gets wrong, so the speed doesn't depend on the load.

use super::calibration::Calibration;
use super::fixed::Divisor;
use super::motion::Motion;
use super::position::approach_speed;
use super::units::{Micrometre, MicrometrePerSecond, MilliDegree, MilliDegreePerSecond};
use super::valve_logic::{Demand, Direction};

/// Follows a requested rate.
#[derive(Clone, Copy, Debug, Default)]
pub struct RateControl {
    /// Ramped rate in millionths of a degree a second, so that slow ramps aren't rounded away.
    rate_micro: i32,
}

impl RateControl {
    /// One step towards `request` (zero: released), not beyond `upper_limit`.
    pub fn demand(
        &mut self,
        request: MilliDegreePerSecond,
        angle: MilliDegree,
        upper_limit: MilliDegree,
        motion: &Motion,
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
        Demand {
            direction,
            speed: wanted.min(speed_before_limit(
                direction,
                upper_limit,
                motion,
                calibration,
            )),
            acceleration: calibration.position.lift_acceleration,
        }
    }
}

/// Fastest speed from which the hitch still stops at the end of its travel.
fn speed_before_limit(
    direction: Direction,
    upper_limit: MilliDegree,
    motion: &Motion,
    calibration: &Calibration,
) -> MicrometrePerSecond {
    let position = &calibration.position;
    let (limit, deceleration) = match direction {
        Direction::Lift => (upper_limit, position.lift_deceleration),
        Direction::Lower => (position.lower_limit, position.lower_deceleration),
    };
    let remaining =
        calibration.linkage.travel(limit) - motion.resting_point(&calibration.hydraulics);
    let ahead = Micrometre(direction.sign(remaining.0));
    if ahead <= position.stop_band {
        MicrometrePerSecond::ZERO
    } else {
        approach_speed(ahead, deceleration, position.approach_gain)
    }
}
