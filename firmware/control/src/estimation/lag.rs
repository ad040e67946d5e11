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
//! braking needs it. Even without any further lag a hitch trails its valve by a usual time, for its load has to be
//! accelerated.
//!
//! What the flow is wrong by leaves the hitch behind as well, but for good, where a lag is made up for once the valve
//! closes. So where the hitch comes to rest tells how much of what it was behind by had another cause: an error of the
//! flow has grown with the way `x`, one of the valve's threshold with the sensitivity `s` to it.

use hitch_quantities::calibration::design_parameters::HydraulicParameters;
use hitch_quantities::fixed::{Divisor, mul_div};
use hitch_quantities::units::{
    MicroLitrePerSecond, Micrometre, MicrometrePerSecond, Microsecond, Millisecond,
};

use super::course::Told;

/// Sum of squares from which the rest of a move tells no more of the lag: 20 ms at full speed.
const COMPLETE: i32 = 400_000;
/// What is known before the first move, as such a sum: valves differ by some 10 ms.
const FIRST_WEIGHT: i32 = 50_000;
/// Most that earlier moves count: oil gets warm.
const MOST_WEIGHT: i32 = 200_000;

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

/// What the calibration says of the lags of lift and lowering valve.
#[must_use]
pub const fn known_lags(hydraulics: &HydraulicParameters) -> [Millisecond; 2] {
    [hydraulics.spool_lag, hydraulics.lower_spool_lag]
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

/// Sums over a move. Ways are in 1.024 um, speeds in 1.024 mm/s, so that a shift makes them; times stay milliseconds.
#[derive(Clone, Copy, Debug, Default)]
pub struct Trail {
    from_nm: i32,
    /// Where the hitch should be by the valves alone, in nanometres.
    expected_nm: i32,
    /// What has passed less than that for each ampere that the valve opens late, nl/A.
    sensitivity_nl: i32,
    /// Sum of speed times sensitivity, in 2048 nl/A.
    speed_sensitivity: i32,
    /// Sum of speed times way behind, in eighths.
    speed_behind: i32,
    speed_squared: i32,
}

impl Trail {
    /// A move begins here.
    #[must_use]
    pub fn from(position_nm: i32) -> Self {
        Self {
            from_nm: position_nm,
            expected_nm: position_nm,
            ..Self::default()
        }
    }

    /// One step; `model`: what the valves should give now, `slope`: how much that changes for each ampere,
    /// `usual`: the time by which a hitch trails them anyway.
    pub fn step(
        &mut self,
        measured_nm: i32,
        model: MicrometrePerSecond,
        slope: MicroLitrePerSecond,
        usual: Eighths,
    ) {
        if self.is_complete() {
            return;
        }
        self.expected_nm = self.expected_nm.saturating_add(model.0);
        self.sensitivity_nl = self.sensitivity_nl.saturating_add(slope.0);
        let speed = model.0 >> 10;
        let of_ampere = speed.wrapping_mul(self.sensitivity_nl >> 11);
        self.speed_sensitivity = self.speed_sensitivity.saturating_add(of_ampere);
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

    /// Takes out what had another cause than a lag, now that the move is over: `of_offset` of what is missing from its
    /// way is the threshold's, the rest the flow's.
    ///
    /// That has grown with the way, and its product with the speed is the integral of `v x / x_end` up to where the sums
    /// ended, `x^2 / 2 x_end`.
    pub fn end(&mut self, told: &Told, of_offset: Micrometre) {
        let way = Divisor::THOUSAND.divide(self.expected_nm.saturating_sub(self.from_nm));
        let way = way.saturating_abs();
        let of_flow = told.missing - of_offset;
        // Eighths, halved.
        let grown = mul_div(of_flow.0, way, Divisor::at_least_one(told.expected.0));
        let by_flow = grown.saturating_mul(way).saturating_mul(4);
        // Some thousand um/ms: what is rounded away is no part of a millisecond.
        let weighted =
            Divisor::at_least_one(told.sensitivity_nl >> 11).divide(self.speed_sensitivity);
        let by_offset = of_offset
            .0
            .saturating_mul(weighted.saturating_abs())
            .saturating_mul(8);
        self.speed_behind = self
            .speed_behind
            .saturating_sub(by_flow)
            .saturating_sub(by_offset);
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
    use super::*;
    use crate::valve::phase::Direction;

    const LIMIT: Eighths = Eighths(8 * 35);

    /// A lift on a valve that opens for a while to `speed` in um/s at most, with the errors of a machine.
    struct Lift {
        speed: f64,
        hold_ms: i32,
        flow_error: f64,
        /// How much slower the spool is than the one of the estimate.
        slower_ms: f64,
        /// By how much of its full stroke the valve opens late.
        late: f64,
    }

    impl Lift {
        /// How much slower the first move tells that the spool is, at rest and 20 ms into its fall, and the second.
        fn told_ms(&self) -> [f64; 3] {
            let mut lag = Lag::default();
            let mut told = [0.0; 3];
            for move_index in 0..2 {
                let mut trail = Trail::from(5_000_000);
                let end = self.drive(&mut trail, lag, |trail| {
                    if move_index == 0 {
                        told[0] = f64::from(trail.further(lag, LIMIT).0) / 8.0;
                    }
                });
                let late = self.late * f64::from(end.sensitivity_nl) / f64::from(SLOPE.0) * FULL;
                trail.end(&end, Micrometre((late * 1e-3) as i32));
                lag.learn(&trail, LIMIT);
                told[move_index + 1] = f64::from(lag.further().0) / 8.0;
            }
            told
        }

        /// The whole move; `falling` sees it 20 ms into its fall.
        fn drive(&self, trail: &mut Trail, lag: Lag, mut falling: impl FnMut(&Trail)) -> Told {
            let lag_ms = 40.0 + f64::from(lag.further().0) / 8.0;
            let (mut model, mut truth) = (0.0, 0.0);
            let (mut expected_nm, mut way_nm, mut sensitivity_nl) = (0.0, 0.0, 0);
            for ms in 0..self.hold_ms + 700 {
                let fall = f64::from((ms - self.hold_ms - 40).max(0)) / 100.0;
                let opening = self.speed * ((f64::from(ms) / 40.0).min(1.0) - fall).max(0.0);
                model += (opening - model) / lag_ms;
                truth += (opening - truth) / (40.0 + self.slower_ms);
                let flow = flow(model);
                let slope = match flow > 0.0 && flow < OPEN {
                    true => SLOPE,
                    false => MicroLitrePerSecond::ZERO,
                };
                expected_nm += flow;
                way_nm += self::flow(truth - self.late * FULL) * (1.0 + self.flow_error);
                sensitivity_nl += slope.0;
                let place_nm = 5_000_000 + way_nm as i32;
                let flow = MicrometrePerSecond(flow as i32);
                trail.step(place_nm, flow, slope, Eighths(0));
                if ms == self.hold_ms + 60 {
                    falling(trail);
                }
            }
            Told {
                direction: Direction::Lift,
                expected: Micrometre((expected_nm * 1e-3) as i32),
                missing: Micrometre(((expected_nm - way_nm) * 1e-3) as i32),
                sensitivity: Micrometre(sensitivity_nl / 4_537),
                sensitivity_nl,
            }
        }
    }

    /// Speed of a spool's full stroke, um/s, the part of it without flow and the part with more and more, and the slope
    /// of the rig's lift valve.
    const FULL: f64 = 147_000.0;
    const SHUT: f64 = 8_000.0;
    const OPEN: f64 = 135_000.0;
    const SLOPE: MicroLitrePerSecond = MicroLitrePerSecond(313_000);

    fn flow(spool: f64) -> f64 {
        (spool - SHUT).clamp(0.0, OPEN)
    }

    #[test]
    fn a_move_tells_the_lag_of_its_spool_before_it_is_braked() {
        for slower_ms in [-15.0, -7.0, 0.0, 7.0, 15.0_f64] {
            for (speed, hold_ms) in [(60_000.0, 30), (100_000.0, 100), (FULL, 400)] {
                for flow_error in [-0.05, 0.0, 0.05] {
                    let told = Lift {
                        speed,
                        hold_ms,
                        flow_error,
                        slower_ms,
                        late: 0.0,
                    }
                    .told_ms();
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
    fn a_valve_that_opens_late_is_no_slow_spool() {
        for late in [-0.05, 0.05] {
            for (speed, hold_ms) in [(60_000.0, 30), (100_000.0, 100), (FULL, 100)] {
                let told = Lift {
                    speed,
                    hold_ms,
                    flow_error: 0.0,
                    slower_ms: 0.0,
                    late,
                }
                .told_ms();
                assert!(told[0] * late > 0.0, "seems slow on the way: {told:?}");
                assert!(
                    told[1..].iter().all(|told_ms| told_ms.abs() <= 4.0),
                    "{late} late at {speed} um/s: {told:?}"
                );
            }
        }
    }

    #[test]
    fn one_valve_tells_of_the_other_until_that_one_moves() {
        let (mut lift, mut lower) = (Lag::default(), Lag::default());
        let late = Trail {
            speed_behind: 8 * 10 * COMPLETE,
            speed_squared: COMPLETE,
            ..Trail::default()
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
                    let slope = MicroLitrePerSecond(place_nm);
                    trail.step(-place_nm.saturating_add(1), model, slope, Eighths(800));
                }
                for missing in [i32::MIN, i32::MAX] {
                    let told = Told {
                        direction: Direction::Lower,
                        expected: Micrometre(i32::MAX),
                        missing: Micrometre(missing),
                        sensitivity: Micrometre(0),
                        sensitivity_nl: missing,
                    };
                    trail.end(&told, Micrometre(place_nm));
                    lag.learn(&trail, LIMIT);
                    assert!(lag.further().0.abs() <= LIMIT.0);
                }
            }
        }
    }
}
