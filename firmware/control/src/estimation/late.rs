//! How much later than the estimate's spool the valves of this machine close, told from where the hitch comes to rest.
//!
//! The estimate takes a spool for a lag of first order, which turns round the moment its coil is cut. One whose current
//! has to decay first, that has a mass, or that sticks goes on as it was for a while, and the hitch with it:
//!
//! ```text
//! rest beyond the cut point = (dt + usual) v        v: the speed at the cut
//! dt += v (beyond - usual v) / (v^2 + W)            W: what earlier moves have told, and at first how alike valves are
//! ```
//!
//! That is a time whatever the order of the spool, and adds to the way from wherever the coil is cut. Spools of 50 rad/s
//! that swing take some 15 ms, of 30 rad/s 20 to 40.

use hitch_quantities::fixed::Divisor;
use hitch_quantities::units::{Micrometre, MicrometrePerSecond};

use super::lag::Eighths;

/// A time of 8 ms is as likely as a rest that is 0.18 mm off for other reasons, as a square of a speed in mm/s.
const FIRST_WEIGHT: i32 = 500;
/// Most that earlier moves count: five at the speed at which coils usually are cut. Oil gets warm.
const MOST_WEIGHT: i32 = 2_000;
/// What a valve is taken to close late by before it has told: a hitch that stops a bit short of its set point is
/// where it should be, one that goes beyond isn't.
const FIRST: Eighths = Eighths(8 * 2);
/// What closes this late is no later than others: the band in which a coil is cut has room for it.
const USUAL: Eighths = Eighths(8 * 4);
/// Latest that a valve is taken to close: more is a load that swings.
const LATEST: Eighths = Eighths(8 * 30);
/// Fastest that a coil is cut at, and furthest that a late valve carries, mm/s and um.
const FAST: i32 = 300;
const FAR: Micrometre = Micrometre(3_000);

/// How late a valve closes, and how sure that is.
#[derive(Clone, Copy, Debug)]
pub struct Late {
    by: Eighths,
    weight: i32,
}

impl Default for Late {
    fn default() -> Self {
        Self {
            by: FIRST,
            weight: FIRST_WEIGHT,
        }
    }
}

impl Late {
    /// How late.
    #[must_use]
    pub const fn by(&self) -> Eighths {
        self.by
    }

    /// The hitch came to rest `beyond` where it should have, both along its way, after its coil was cut at `speed`.
    ///
    /// No spool closes sooner than one of first order: what falls short has another cause.
    pub fn learn(&mut self, beyond: Micrometre, speed: MicrometrePerSecond) {
        let speed = (speed.0 >> 10).clamp(-FAST, FAST);
        let beyond = beyond.limited(Micrometre(-FAR.0), FAR);
        let squared = speed.wrapping_mul(speed);
        self.weight = self.weight.saturating_add(squared);
        let further = speed
            .wrapping_mul(beyond.0 << 3)
            .wrapping_sub(squared.wrapping_mul(USUAL.0));
        let by = self.by + Eighths(Divisor::at_least_one(self.weight).divide(further));
        self.by = by.max(Eighths(0)).min(LATEST);
        self.weight = self.weight.min(MOST_WEIGHT);
    }

    /// Valves of one kind are alike: what the other one was told holds here, until this one has told better.
    pub fn assume(&mut self, other: Self) {
        if self.weight == FIRST_WEIGHT {
            self.by = other.by;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// How far a valve that closes `late_ms` later than `late` says carries the hitch at `speed_mm_s`, um.
    fn beyond(late: Late, late_ms: i32, speed_mm_s: i32) -> Micrometre {
        Micrometre((8 * late_ms + USUAL.0 - late.by().0) * speed_mm_s / 8)
    }

    /// What moves tell of a valve that closes `late_ms` late after cuts at `speed_mm_s`.
    fn told_ms(late_ms: i32, speed_mm_s: i32, moves: usize) -> f64 {
        let mut late = Late::default();
        for _ in 0..moves {
            let beyond = beyond(late, late_ms, speed_mm_s);
            late.learn(beyond, MicrometrePerSecond(speed_mm_s * 1_000));
        }
        f64::from(late.by().0) / 8.0
    }

    #[test]
    fn a_few_moves_tell_how_late_a_valve_closes() {
        for late_ms in [0, 5, 10, 20] {
            for (speed_mm_s, moves) in [(20, 5), (-20, 5), (60, 2)] {
                let error_ms = (told_ms(late_ms, speed_mm_s, moves) - f64::from(late_ms)).abs();
                assert!(
                    error_ms <= 1.0 + 0.25 * f64::from(late_ms),
                    "{late_ms} ms at {speed_mm_s} mm/s: off by {error_ms}"
                );
            }
        }
    }

    #[test]
    fn a_valve_is_late_until_it_has_told_that_it_is_not() {
        assert!(told_ms(0, 60, 0) >= 1.0);
        assert!(told_ms(0, 60, 2) < 0.3);
    }

    #[test]
    fn a_slow_move_tells_little() {
        assert!(told_ms(20, 5, 1) - told_ms(20, 5, 0) < 2.0);
    }

    #[test]
    fn one_valve_tells_of_the_other_until_that_one_moves() {
        let (mut lift, mut lower) = (Late::default(), Late::default());
        let speed = MicrometrePerSecond(50_000);
        lift.learn(beyond(lift, 16, 50), speed);
        lower.assume(lift);
        assert_eq!(lower.by(), lift.by());
        assert!(lower.by() > Eighths(8 * 10), "{lower:?}");
        lower.learn(beyond(lower, 16, 50), speed);
        let told = lower.by();
        lower.assume(Late::default());
        assert_eq!(lower.by(), told);
    }

    #[test]
    fn extremes_and_shortfalls_stay_within_what_valves_do() {
        for beyond in [i32::MIN, -1_000, 0, 1_000, i32::MAX] {
            for speed in [i32::MIN, -300_000, 0, 300_000, i32::MAX] {
                let mut late = Late::default();
                for _ in 0..10 {
                    late.learn(Micrometre(beyond), MicrometrePerSecond(speed));
                    assert!((0..=LATEST.0).contains(&late.by().0));
                }
            }
        }
    }
}
