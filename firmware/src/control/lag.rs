//! How slow this machine's spools are, told from how far the hitch trails its valve.
//!
//! A spool that is slower by `dT` than the estimate takes it for leaves the hitch behind by `dT v`, where `v` is the
//! speed that its opening gives, whatever that does meanwhile. So at any moment of a move
//!
//! ```text
//! dT = sum(v behind) / (sum(v^2) + W)      W: what earlier moves have told, and at first how alike valves are
//! ```
//!
//! which is early enough for braking that very move, and is kept for the next. It has the sensor's lag in it, as
//! braking needs it. What the flow is wrong by leaves the hitch behind as well, but with the whole way and not with the
//! speed: the sums end early, and of a move that is too short for that the rest tells how much it was. Even without any
//! further lag a hitch trails its valve by a usual time, for its load has to be accelerated.

use super::course::Told;
use super::fixed::Divisor;
use super::units::{MicrometrePerSecond, Microsecond, Millisecond};

/// Sum of squares from which the rest of a move tells no more of the lag: 20 ms at full speed.
const COMPLETE: i32 = 200_000;
/// What is known before the first move, as such a sum: valves differ by some 10 ms.
const FIRST_WEIGHT: i32 = 25_000;
/// Most that earlier moves count: oil gets warm.
const MOST_WEIGHT: i32 = 100_000;

/// A lag, or a part of one, in eighths of a millisecond.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Eighths(pub i32);

impl Eighths {
    /// That many in a second.
    pub const IN_SECOND: Divisor = Divisor::at_least_one(8_000);

    /// Whole milliseconds of it, at least one, to divide by.
    #[must_use]
    pub const fn divisor(self) -> Divisor {
        Divisor::at_least_one(self.0.saturating_add(4) >> 3)
    }

    fn limited(self, limit: Self) -> Self {
        self.max(Self(limit.0.saturating_neg())).min(limit)
    }
}

impl From<Microsecond> for Eighths {
    fn from(time: Microsecond) -> Self {
        Self(time.0 / 125)
    }
}

impl From<Millisecond> for Eighths {
    fn from(time: Millisecond) -> Self {
        // Milliseconds of a calibration are few.
        Self(time.0 << 3)
    }
}

impl core::ops::Sub for Eighths {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self(self.0.saturating_sub(other.0))
    }
}

impl core::ops::Add for Eighths {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(self.0.saturating_add(other.0))
    }
}

/// How much slower than the calibration says the spool of a valve is, and how sure that is.
#[derive(Clone, Copy, Debug)]
pub struct Lag {
    further: Eighths,
    weight: i32,
}

impl Default for Lag {
    fn default() -> Self {
        Self {
            further: Eighths(0),
            weight: FIRST_WEIGHT,
        }
    }
}

impl Lag {
    /// How much slower.
    #[must_use]
    pub const fn further(&self) -> Eighths {
        self.further
    }

    /// How much slower, as far as moves of its own have told.
    #[must_use]
    pub fn told(&self) -> Eighths {
        match self.weight > FIRST_WEIGHT {
            true => self.further,
            false => Eighths(0),
        }
    }

    /// Takes in a `trail` that is over; `limit`: furthest that a spool may be slower or faster.
    #[inline(never)]
    pub fn learn(&mut self, trail: &Trail, limit: Eighths) {
        self.further = (self.further + trail.further(*self, limit)).limited(limit);
        self.weight = self
            .weight
            .saturating_add(trail.speed_squared)
            .min(MOST_WEIGHT);
    }

    /// Valves of one kind are alike: what the other one was told holds here, until a move of this one has told better.
    pub fn assume(&mut self, other: Self) {
        if self.weight == FIRST_WEIGHT {
            self.further = other.further;
        }
    }
}

/// Sums over a move, in which every other step is looked at. Ways are in 1.024 um, speeds in 1.024 mm/s, so that a
/// shift makes them; times stay milliseconds.
#[derive(Clone, Copy, Debug, Default)]
pub struct Trail {
    /// Where the hitch should be by the valves alone, in nanometres.
    expected_nm: i32,
    /// Sum of speed times way behind, in eighths.
    speed_behind: i32,
    speed_squared: i32,
}

impl Trail {
    /// A move begins here.
    #[must_use]
    pub fn from(position_nm: i32) -> Self {
        Self {
            expected_nm: position_nm,
            ..Self::default()
        }
    }

    /// Every other step; `model`: what the valves should give now, `usual`: the time by which a hitch trails them
    /// anyway.
    pub fn step(&mut self, measured_nm: i32, model: MicrometrePerSecond, usual: Eighths) {
        if self.is_complete() {
            return;
        }
        self.expected_nm = self
            .expected_nm
            .saturating_add(model.0)
            .saturating_add(model.0);
        let speed = model.0 >> 10;
        let behind = self.expected_nm.saturating_sub(measured_nm) >> 7;
        let further = behind.saturating_sub(speed.wrapping_mul(usual.0));
        // 16 mm behind at 400 mm/s fit; an absurd product may be any.
        self.speed_behind = self
            .speed_behind
            .saturating_add(speed.wrapping_mul(further));
        self.speed_squared = self
            .speed_squared
            .saturating_add(speed.wrapping_mul(speed).max(0));
    }

    const fn is_complete(&self) -> bool {
        self.speed_squared >= COMPLETE
    }

    /// Takes out what the flow of a whole move was wrong by: if that has grown with the way `x`, it is the integral
    /// of `v x / x_end`, half of the way.
    pub fn end(&mut self, told: &Told) {
        if !self.is_complete() {
            // Eighths of every other step, halved.
            let of_flow = told
                .expected
                .0
                .saturating_mul(told.missing.0)
                .saturating_mul(2);
            self.speed_behind = self.speed_behind.saturating_sub(of_flow);
        }
    }

    /// How much slower than `lag` the spool is.
    #[must_use]
    pub fn further(&self, lag: Lag, limit: Eighths) -> Eighths {
        let weight = self.speed_squared.saturating_add(lag.weight);
        Eighths(Divisor::at_least_one(weight).divide(self.speed_behind)).limited(limit)
    }
}

#[cfg(test)]
mod tests {
    use super::super::units::Micrometre;
    use super::super::valve_logic::Direction;
    use super::*;

    const LIMIT: Eighths = Eighths(8 * 35);

    /// A lift that rises to `speed` in um/s for `hold_ms` and falls again, with a spool that is `slower_ms` slower than
    /// the one of the estimate: how much slower the first move tells that it is, at rest and 20 ms into its fall, and
    /// the second.
    fn told_ms(speed: f64, hold_ms: i32, flow_error: f64, slower_ms: f64) -> [f64; 3] {
        let mut lag = Lag::default();
        let mut told = [0.0; 3];
        for move_index in 0..2 {
            let lag_ms = 40.0 + f64::from(lag.further().0) / 8.0;
            let mut trail = Trail::from(5_000_000);
            let (mut model, mut truth) = (0.0, 0.0);
            let (mut expected_nm, mut place_nm) = (0.0, 5_000_000.0);
            for ms in 0..hold_ms + 700 {
                let falling = f64::from((ms - hold_ms - 40).max(0)) / 100.0;
                let opening = speed * ((f64::from(ms) / 40.0).min(1.0) - falling).max(0.0);
                model += (opening - model) / lag_ms;
                truth += (opening - truth) / (40.0 + slower_ms);
                expected_nm += model;
                place_nm += truth * (1.0 + flow_error);
                if ms % 2 == 0 {
                    trail.step(
                        place_nm as i32,
                        MicrometrePerSecond(model as i32),
                        Eighths(0),
                    );
                }
                if ms == hold_ms + 60 && move_index == 0 {
                    told[0] = f64::from(trail.further(lag, LIMIT).0) / 8.0;
                }
            }
            trail.end(&Told {
                direction: Direction::Lift,
                expected: Micrometre((expected_nm * 1e-3) as i32),
                missing: Micrometre(((expected_nm - place_nm + 5_000_000.0) * 1e-3) as i32),
                sensitivity: Micrometre(0),
            });
            lag.learn(&trail, LIMIT);
            told[move_index + 1] = f64::from(lag.further().0) / 8.0;
        }
        told
    }

    #[test]
    fn a_move_tells_the_lag_of_its_spool_before_it_is_braked() {
        for slower_ms in [-15.0, -7.0, 0.0, 7.0, 15.0_f64] {
            for (speed, hold_ms) in [(60_000.0, 30), (100_000.0, 100), (147_000.0, 400)] {
                for flow_error in [-0.05, 0.0, 0.05] {
                    let told = told_ms(speed, hold_ms, flow_error, slower_ms);
                    // A third is told while spool and load still follow, the rest by the next moves.
                    for (told_ms, share) in told.into_iter().zip([0.7, 0.7, 0.5]) {
                        let error_ms = (told_ms - slower_ms).abs();
                        assert!(
                            error_ms <= 2.0 + share * slower_ms.abs() + 80.0 * flow_error.abs(),
                            "{slower_ms} ms at {speed} um/s, flow {flow_error}: {told:?}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn one_valve_tells_of_the_other_until_that_one_moves() {
        let (mut lift, mut lower) = (Lag::default(), Lag::default());
        let late = Trail {
            expected_nm: 0,
            speed_behind: 8 * 10 * COMPLETE,
            speed_squared: COMPLETE,
        };
        lift.learn(&late, LIMIT);
        lower.assume(lift);
        assert_eq!(lower.further(), lift.further());
        assert_eq!(lower.told(), Eighths(0), "hearsay");
        assert!((60..=80).contains(&lift.further().0), "{lift:?}");
        lower.learn(&Trail::default(), LIMIT);
        lower.learn(&late, LIMIT);
        assert_eq!(lower.told(), lower.further());
        let before = lower.further();
        lower.assume(Lag::default());
        assert_eq!(lower.further(), before);
    }

    #[test]
    fn extremes_stay_within_the_limit() {
        for place_nm in [i32::MIN, 0, i32::MAX] {
            for speed in [i32::MIN, -300_000, 0, 300_000, i32::MAX] {
                let mut trail = Trail::from(place_nm);
                let mut lag = Lag::default();
                for _ in 0..1_000 {
                    let model = MicrometrePerSecond(speed);
                    trail.step(-place_nm.saturating_add(1), model, Eighths(800));
                }
                for missing in [i32::MIN, i32::MAX] {
                    trail.end(&Told {
                        direction: Direction::Lower,
                        expected: Micrometre(i32::MAX),
                        missing: Micrometre(missing),
                        sensitivity: Micrometre(0),
                    });
                    lag.learn(&trail, LIMIT);
                    assert!(lag.further().0.abs() <= LIMIT.0);
                }
            }
        }
    }
}
