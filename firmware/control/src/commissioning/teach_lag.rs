//! The lag of a spool, taught: how long after a step of current the hitch moves as fast as its valve lets it.
//!
//! Behind a step every curve opens in a time that goes with the lag `T` of its spool, however it is bent. Once the
//! speed is steady the way is a straight line over the time, and where that line begins is the delay:
//!
//! ```text
//! x(t) = v (t - t0)      t0 = (x2 t1 - x1 t2) / (x2 - x1)      T = T_twin (t0 - 8/5 usual) / t0_twin
//! ```
//!
//! By a usual time a hitch trails its valve anyway, for its load has to be accelerated; by three fifths more than on a
//! move, for the little flow of a step takes longer to raise the pressure against friction.
//! Load and oil change `v`, of which `t0` is free. The twin takes the same step on the calibration's curve and spool,
//! through the same filter. Means over two windows leave little of sensor's noise and load's swing.

use hitch_quantities::fixed::{Divisor, mul_div};
use hitch_quantities::units::{Micrometre, Microsecond, Millisecond};

/// How long the current is on.
pub const STEP: Millisecond = Millisecond(800);
/// The windows begin here, and are so long: the slowest spool has opened, and a load has swung at least once in each.
const EARLY: i32 = 300;
const LATE: i32 = 600;
const WINDOW: i32 = 200;
/// Their middles, in milliseconds.
const MIDDLES: (i32, i32) = (EARLY + WINDOW / 2, LATE + WINDOW / 2);
/// Sums of a hitch that is slower than 4 mm/s tell nothing: it has come to an end.
const LEAST: i32 = 4 * (LATE - EARLY) * WINDOW;

/// Sums of the way over both windows, in micrometres, and what follows them.
#[derive(Clone, Copy, Debug, Default)]
pub struct Way {
    early: i32,
    late: i32,
    /// The way when the windows were over, and the last one.
    steady: Micrometre,
    last: Micrometre,
}

impl Way {
    /// The way at an `age` of the step.
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

    /// Where the line through the means of both windows begins, ms; `None` if there is no such line.
    fn delay(&self) -> Option<i32> {
        let later = self.time_for(self.early, MIDDLES.1 - MIDDLES.0)?;
        Some(MIDDLES.0.saturating_sub(later))
    }

    /// How long the way since the windows would have taken at the steady speed, ms.
    #[must_use]
    pub fn coasting_time(&self) -> Option<i32> {
        self.time_for((self.last - self.steady).0, WINDOW * (LATE - EARLY))
    }

    /// `sum` over the rise between the windows, times `scale`, if that rise is a speed.
    fn time_for(&self, sum: i32, scale: i32) -> Option<i32> {
        let rise = self.late.saturating_sub(self.early);
        let time = mul_div(sum, scale, Divisor::at_least_one(rise));
        (rise >= LEAST).then_some(time)
    }
}

/// The lag of the spool that went the `real` way, but for a `usual` time, where the calibration's with `known` lag went
/// the `twin` way: what is known, if the two are further apart than the `limit`.
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
    match (lag - known).magnitude() > limit {
        true => known,
        false => lag,
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
