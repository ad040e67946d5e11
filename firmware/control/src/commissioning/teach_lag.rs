//! Identification of a spool lag from a current step.
//!
//! After a step every curve opens in a time that is proportional to the lag `T` of its spool, whatever its shape. At
//! constant speed the travel is a straight line over time, and the intercept of that line is the delay:
//!
//! ```text
//! x(t) = v (t - t0)      t0 = (x2 t1 - x1 t2) / (x2 - x1)      T = T_twin (t0 - 8/5 usual) / t0_twin
//! ```
//!
//! A hitch trails its valve by a usual time, because its load has to be accelerated. At a step this time is larger by
//! three fifths than in a move, because the small flow takes longer to raise the pressure against friction. Load and
//! oil change `v`, which `t0` does not depend on. The twin performs the same step with the curve and the spool of the
//! calibration, through the same filter. Means over two windows suppress the noise of the sensor and the oscillation of
//! the load.

use hitch_quantities::fixed::{Divisor, mul_div};
use hitch_quantities::units::{Micrometre, Microsecond, Millisecond};

/// Duration of the current.
pub const STEP: Millisecond = Millisecond(800);
/// Begin and length of the windows: the slowest spool has opened, and each window contains an oscillation of the load.
const EARLY: i32 = 300;
const LATE: i32 = 600;
const WINDOW: i32 = 200;
/// Their middles, ms.
const MIDDLES: (i32, i32) = (EARLY + WINDOW / 2, LATE + WINDOW / 2);
/// Smallest sum: a hitch that is slower than 4 mm/s has reached an end.
const LEAST: i32 = 4 * (LATE - EARLY) * WINDOW;

/// Sums of the travel over both windows, um, and the travel after them.
#[derive(Clone, Copy, Debug, Default)]
pub struct Way {
    early: i32,
    late: i32,
    /// The travel at the end of the windows, and the latest one.
    steady: Micrometre,
    last: Micrometre,
}

impl Way {
    /// Takes in the travel at an `age` of the step.
    pub fn note(&mut self, age: Millisecond, way: Micrometre) {
        if (EARLY..EARLY + WINDOW).contains(&age.0) {
            self.early = self.early.saturating_add(way.0);
        } else if (LATE..LATE + WINDOW).contains(&age.0) {
            self.late = self.late.saturating_add(way.0);
        }
        if age <= STEP {
            self.steady = way;
        }
        self.last = way;
    }

    /// Intercept of the line through the means of both windows, ms; `None` if there is no such line.
    fn delay(&self) -> Option<i32> {
        let later = self.time_for(self.early, MIDDLES.1 - MIDDLES.0)?;
        Some(MIDDLES.0.saturating_sub(later))
    }

    /// Time that the travel since the windows takes at the constant speed, ms.
    #[must_use]
    pub fn coasting_time(&self) -> Option<i32> {
        self.time_for((self.last - self.steady).0, WINDOW * (LATE - EARLY))
    }

    /// `sum` over the rise between the windows, times `scale`, if the hitch moves.
    fn time_for(&self, sum: i32, scale: i32) -> Option<i32> {
        let rise = self.late.saturating_sub(self.early);
        let time = mul_div(sum, scale, Divisor::at_least_one(rise));
        (rise >= LEAST).then_some(time)
    }
}

/// Lag of a spool from the `real` travel, with the `usual` time subtracted, and the `twin` travel with the `known` lag
/// of the calibration. It is the known lag if the two differ by more than the `limit`.
#[must_use]
pub fn found(
    real: &Way,
    twin: &Way,
    usual: Microsecond,
    known: Millisecond,
    limit: Millisecond,
) -> Millisecond {
    let (Some(real), Some(twin)) = (real.delay(), twin.delay()) else {
        return known;
    };
    let delay = real.saturating_sub(usual.0.saturating_mul(8) / 5_000);
    let lag = Millisecond(mul_div(known.0, delay, Divisor::at_least_one(twin)));
    if (lag - known).magnitude() > limit {
        known
    } else {
        lag
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const KNOWN: Millisecond = Millisecond(40);
    const USUAL: Microsecond = Microsecond(6_500);

    /// The way behind a spool whose delay is `delay_ms`, at a steady `speed`, mm/s.
    fn way(delay_ms: i32, speed: i32) -> Way {
        let mut way = Way::default();
        for age in 0..STEP.0 {
            let gone = Micrometre(speed * (age - delay_ms).max(0));
            way.note(Millisecond(age), gone);
        }
        way
    }

    fn lag(real: &Way, twin: &Way) -> i32 {
        found(real, twin, USUAL, KNOWN, Millisecond(30)).0
    }

    #[test]
    fn the_lag_goes_with_the_delay_whatever_the_load_and_the_oil_make_of_the_speed() {
        let twin = way(120, 17);
        for speed in [8, 17, 30] {
            for (delay_ms, lag_ms) in [(100, 30), (130, 40), (175, 55)] {
                let found = lag(&way(delay_ms, speed), &twin);
                assert!((found - lag_ms).abs() <= 1, "{found} for {delay_ms} ms");
            }
        }
    }

    #[test]
    fn what_is_implausible_is_not_taken_for_a_lag() {
        let twin = way(120, 17);
        let mut at_an_end = Way::default();
        for age in 0..STEP.0 {
            at_an_end.note(Millisecond(age), Micrometre((17 * age).min(3_000)));
        }
        let backwards = way(120, -17);
        for real in [
            Way::default(),
            at_an_end,
            backwards,
            way(290, 17),
            way(1, 17),
        ] {
            assert_eq!(lag(&real, &twin), KNOWN.0);
        }
        assert_eq!(lag(&twin, &Way::default()), KNOWN.0);
    }
}
