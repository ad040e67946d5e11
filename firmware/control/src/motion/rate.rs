//! Rate control: the rocker turns at the speed that a button asks for, as long as it is held.
//!
//! The asked rate is ramped, turned into piston speed by the linkage, and slowed down before the ends of
//! travel with the same profile as position control. The motion estimate's bias corrects what the
//! valve map gets wrong, so the speed doesn't depend on the load. Where a valve's hysteresis leaves a rest of
//! error, as on the kink of a curve, a slow integral takes it away once the ramp is over.

use hitch_quantities::Calibration;
use hitch_quantities::calibration::design_parameters::RateParameters;
use hitch_quantities::fixed::Divisor;
use hitch_quantities::units::{Micrometre, MicrometrePerSecond, MilliDegree, MilliDegreePerSecond};

use super::position::approach_speed;
use crate::estimation::motion::Motion;
use crate::valve::phase::{Demand, Direction};

/// Follows a requested rate.
#[derive(Clone, Copy, Debug, Default)]
pub struct RateControl {
    /// Ramped rate in millionths of a degree a second, so that slow ramps aren't rounded away.
    rate_micro: i32,
    /// Piston speed along the way that the valve has to be asked for less, in nanometres a second.
    trim_nm_per_s: i32,
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

    /// Piston speed along the way that the valve has to be asked for less.
    #[must_use]
    pub fn trim(&self) -> MicrometrePerSecond {
        MicrometrePerSecond(Divisor::THOUSAND.divide(self.trim_nm_per_s))
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
        calibration.linkage.travel(limit) - motion.run_on(&calibration.hydraulics).resting_point();
    let ahead = Micrometre(direction.sign(remaining.0));
    if ahead <= position.stop_band {
        MicrometrePerSecond::ZERO
    } else {
        approach_speed(ahead, deceleration, position.approach_gain)
    }
}
