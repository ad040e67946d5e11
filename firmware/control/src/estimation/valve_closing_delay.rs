//! Closing delay of the valves beyond the first-order spool model, identified from where the hitch comes to rest.
//!
//! The model is a first-order lag, which changes direction as soon as the coil is cut. A spool whose current decays
//! first, that has a mass, or that sticks stays open for some time longer, and the hitch moves on:
//!
//! ```text
//! rest position beyond the predicted one = (dt + usual) v    v: speed at the cut
//! dt += v (error - usual v) / (v^2 + W)                      W: weight of earlier moves; initially the valve spread
//! ```
//!
//! The result is a time for a spool of any order. It adds to the predicted stopping distance at any cut position.
//! Underdamped spools of 50 rad/s take some 15 ms, those of 30 rad/s 20 to 40 ms.

use hitch_quantities::fixed::Divisor;
use hitch_quantities::units::{Micrometre, MicrometrePerSecond, Millisecond};

use super::millisecond_q3::MillisecondQ3;

/// Initial weight, (mm/s)^2: a delay of 8 ms is as likely as a position error of 0.18 mm from other causes.
const INITIAL_WEIGHT: i32 = 500;
/// Largest weight of earlier moves: five moves at the usual speed at the cut. The oil temperature changes.
const MAX_WEIGHT: i32 = 2_000;
/// Delay before identification. It is positive, because a slight undershoot stays within the tolerance and an overshoot
/// does not.
const INITIAL_DELAY: MillisecondQ3 = MillisecondQ3(8 * 2);
/// A delay that the stop band covers.
const USUAL_DELAY: MillisecondQ3 = MillisecondQ3(8 * 4);
/// Largest delay in quarters of the calibrated spool lag: a larger one is an oscillating load.
const MAX_QUARTERS: i32 = 3;
/// Largest speed at the cut, mm/s, and largest position error.
const MAX_SPEED: i32 = 300;
const MAX_ERROR: Micrometre = Micrometre(3_000);

/// Closing delay of a valve, with the weight of the estimate.
#[derive(Clone, Copy, Debug)]
pub struct ValveClosingDelay {
    delay: MillisecondQ3,
    weight: i32,
}

impl Default for ValveClosingDelay {
    fn default() -> Self {
        Self {
            delay: INITIAL_DELAY,
            weight: INITIAL_WEIGHT,
        }
    }
}

impl ValveClosingDelay {
    /// The delay.
    #[must_use]
    pub const fn delay(&self) -> MillisecondQ3 {
        self.delay
    }

    /// Takes in the position error at rest (positive: overshoot) after a cut at `speed`. Both are positive in the
    /// direction of the move. `spool_lag`: that of the calibration.
    ///
    /// No spool closes earlier than the model. An undershoot has another cause.
    pub fn learn(
        &mut self,
        beyond: Micrometre,
        speed: MicrometrePerSecond,
        spool_lag: Millisecond,
    ) {
        let speed = (speed.0 >> 10).clamp(-MAX_SPEED, MAX_SPEED);
        let beyond = beyond.limited(Micrometre(-MAX_ERROR.0), MAX_ERROR);
        let squared = speed.wrapping_mul(speed);
        self.weight = self.weight.saturating_add(squared);
        let further = speed
            .wrapping_mul(beyond.0 << 3)
            .wrapping_sub(squared.wrapping_mul(USUAL_DELAY.0));
        let delay = self.delay + MillisecondQ3(Divisor::at_least_one(self.weight).divide(further));
        self.delay = delay.max(MillisecondQ3(0)).min(largest(spool_lag));
        self.weight = self.weight.min(MAX_WEIGHT);
    }

    /// Both valves are of one kind: the other one's estimate is the initial value until this valve has been identified.
    pub fn initialize_from(&mut self, other: Self) {
        if self.weight == INITIAL_WEIGHT {
            self.delay = other.delay;
        }
    }
}

/// Largest delay of a spool with this lag.
const fn largest(spool_lag: Millisecond) -> MillisecondQ3 {
    // Eighths of a millisecond.
    MillisecondQ3(spool_lag.0.saturating_mul(8 * MAX_QUARTERS / 4))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lag of the rig's spools.
    const LAG: Millisecond = Millisecond(40);

    /// Position error at `speed_mm_s` of a valve with this delay, um.
    fn beyond(valve: ValveClosingDelay, delay_ms: i32, speed_mm_s: i32) -> Micrometre {
        Micrometre((8 * delay_ms + USUAL_DELAY.0 - valve.delay().0) * speed_mm_s / 8)
    }

    /// Delay that moves identify, cut at `speed_mm_s`.
    fn identified_ms(delay_ms: i32, speed_mm_s: i32, moves: usize) -> f64 {
        let mut valve = ValveClosingDelay::default();
        for _ in 0..moves {
            let beyond = beyond(valve, delay_ms, speed_mm_s);
            valve.learn(beyond, MicrometrePerSecond(speed_mm_s * 1_000), LAG);
        }
        f64::from(valve.delay().0) / 8.0
    }

    #[test]
    fn a_few_moves_identify_the_closing_delay() {
        for delay_ms in [0, 5, 10, 20] {
            for (speed_mm_s, moves) in [(20, 5), (-20, 5), (60, 2)] {
                let error_ms =
                    (identified_ms(delay_ms, speed_mm_s, moves) - f64::from(delay_ms)).abs();
                assert!(
                    error_ms <= 1.0 + 0.25 * f64::from(delay_ms),
                    "{delay_ms} ms at {speed_mm_s} mm/s: off by {error_ms}"
                );
            }
        }
    }

    #[test]
    fn the_initial_delay_is_positive() {
        assert!(identified_ms(0, 60, 0) >= 1.0);
        assert!(identified_ms(0, 60, 2) < 0.3);
    }

    #[test]
    fn a_slow_move_has_a_small_weight() {
        assert!(identified_ms(20, 5, 1) - identified_ms(20, 5, 0) < 2.0);
    }

    #[test]
    fn one_valve_initializes_the_other_until_that_one_moves() {
        let (mut lift, mut lower) = (ValveClosingDelay::default(), ValveClosingDelay::default());
        let speed = MicrometrePerSecond(50_000);
        lift.learn(beyond(lift, 16, 50), speed, LAG);
        lower.initialize_from(lift);
        assert_eq!(lower.delay(), lift.delay());
        assert!(lower.delay() > MillisecondQ3(8 * 10), "{lower:?}");
        lower.learn(beyond(lower, 16, 50), speed, LAG);
        let identified = lower.delay();
        lower.initialize_from(ValveClosingDelay::default());
        assert_eq!(lower.delay(), identified);
    }

    #[test]
    fn extremes_and_undershoots_stay_within_the_limits() {
        for lag in [Millisecond(0), LAG, Millisecond(500)] {
            for beyond in [i32::MIN, -1_000, 0, 1_000, i32::MAX] {
                for speed in [i32::MIN, -300_000, 0, 300_000, i32::MAX] {
                    let mut valve = ValveClosingDelay::default();
                    for _ in 0..10 {
                        valve.learn(Micrometre(beyond), MicrometrePerSecond(speed), lag);
                        assert!((0..=largest(lag).0).contains(&valve.delay().0));
                    }
                }
            }
        }
    }
}
