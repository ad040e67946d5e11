//! Where the piston stops: without a demand from now on, or with the coil cut now.

use hitch_quantities::fixed::Divisor;
use hitch_quantities::units::{Micrometre, MicrometrePerSecond};

use super::millisecond_q3::MillisecondQ3;

/// Predicted stop of the piston.
#[derive(Clone, Copy, Debug)]
pub struct StopPrediction {
    /// Stop without spool lag. It contains the stopping distance of a sinking load ([`super::free_fall`])
    /// and the closing delay ([`super::valve_closing_delay`]).
    pub without_lag: Micrometre,
    /// Distance that the spool lag adds.
    pub lag_distance: Micrometre,
}

impl StopPrediction {
    /// Stop position if the demanded speed is zero from now on.
    ///
    /// With a first-order spool, `v' = (u - v) / T`, the point `P = x + T v` moves with exactly the
    /// demanded speed: `P' = v + T v' = u`. A control law for `P` needs no lag compensation.
    #[must_use]
    pub fn predicted_stop(&self) -> Micrometre {
        self.without_lag + self.lag_distance
    }

    /// Stop position if the coil is cut now; `share` is [`super::motion_observer::MotionObserver::closing_share`].
    #[must_use]
    pub fn predicted_stop_after_cut(&self, share: i32) -> Micrometre {
        self.without_lag + self.lag_distance.scaled(share, Divisor::THOUSAND)
    }
}

/// Distance at this speed in a lag or delay. The product fits a word: the speed is limited, and the largest lag
/// (calibration plus identified) is 0.7 s.
#[must_use]
pub fn distance_in(time: MillisecondQ3, speed: MicrometrePerSecond) -> Micrometre {
    const MAX_SPEED: MicrometrePerSecond = MicrometrePerSecond(380_000);
    let speed = speed.limited(-MAX_SPEED, MAX_SPEED);
    Micrometre(MillisecondQ3::IN_SECOND.divide(speed.0.wrapping_mul(time.0)))
}
