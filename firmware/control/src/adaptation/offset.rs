//! How far this machine's valves are off their curves, told from how far its moves go ([`crate::estimation::course`]).
//!
//! Valves of one kind differ by 0.1 A in where they open, and hysteresis adds half of its width. What else shortens a
//! way (oil, load, a compensator that droops) goes with the way itself, and the sensor's noise is there in any case, so
//! it is a short move that tells. How much of the difference is believed is the share that the present doubt can make
//! of it (a Kalman filter of one state):
//!
//! ```text
//! a = doubt * sensitivity     share = a^2 / (a^2 + noise^2 + (error of the flow * way)^2)     doubt^2 *= 1 - share
//! ```
//!
//! An offset changes only at rest, is bounded, and is forgotten with the supply. A way that is shorter than all of this
//! can make it is no offset: something stood in the way. Nothing takes a hitch further than its valve lets it: then what
//! was believed is wrong, and all doubt is back.

use hitch_quantities::CoilCurrents;
use hitch_quantities::fixed::{Divisor, mul_div, square_root};
use hitch_quantities::units::{Micrometre, MilliAmp};

use crate::estimation::course::Told;
use crate::valve::phase::Direction;

/// Furthest that a valve may be off: one that is further off has to be taught.
const MOST: MilliAmp = MilliAmp(160);
/// What a lift valve is taken to open late by before anything was learnt. A curve is the mean of both ways through a
/// hysteresis, and half of a usual one is 60 mA; closing, of which the calibration knows, makes the most of it good.
pub const FIRST_LIFT: MilliAmp = MilliAmp(20);
/// Doubt before anything was learnt: spread of thresholds, and half of the hysteresis.
const FIRST_DOUBT: MilliAmp = MilliAmp(70);
/// Doubt that stays: coils get warm, and hysteresis hides as much.
const LEAST_DOUBT: MilliAmp = MilliAmp(20);
/// One sigma of what a way is off by whatever its length: the averaged sensor, play of pins, how the valve fell shut.
const NOISE: Micrometre = Micrometre(300);
/// One sigma of the error of the flow when lifting, in thousandths: it is compensated ...
const LIFT_ERROR: i32 = 25;
/// ... and when lowering, where load and oil are known badly and the drag of the piston isn't.
const LOWER_ERROR: i32 = 150;
/// A difference of so many sigmas is no offset.
const BELIEVABLE: i32 = 3;

/// Offsets of both valves.
#[derive(Clone, Copy, Debug)]
pub struct Offsets {
    lift: Belief,
    lower: Belief,
}

impl Default for Offsets {
    fn default() -> Self {
        Self {
            lift: Belief::first(FIRST_LIFT),
            lower: Belief::first(MilliAmp::ZERO),
        }
    }
}

/// An offset and how sure it is.
#[derive(Clone, Copy, Debug)]
struct Belief {
    offset: MilliAmp,
    doubt: MilliAmp,
}

impl Offsets {
    /// How much more current the lift valve takes than its curve says.
    #[must_use]
    pub const fn lift(&self) -> MilliAmp {
        self.lift.offset
    }

    /// How much more current the lowering valve takes than its curve says.
    #[must_use]
    pub const fn lower(&self) -> MilliAmp {
        self.lower.offset
    }

    /// The currents at which the curves give what these valves give under `currents`.
    #[must_use]
    pub fn on_curve(&self, currents: CoilCurrents) -> CoilCurrents {
        CoilCurrents {
            lift: currents.lift - self.lift.offset,
            lower: currents.lower - self.lower.offset,
        }
    }

    /// How much of what is missing from a move can be blamed on its valve's threshold.
    #[must_use]
    pub fn blamed(&self, told: &Told) -> Micrometre {
        let share = match told.direction {
            Direction::Lift => self.lift.share(told, LIFT_ERROR),
            Direction::Lower => self.lower.share(told, LOWER_ERROR),
        };
        told.missing.scaled(share, Divisor::THOUSAND)
    }

    /// Takes in what a move told.
    pub fn learn(&mut self, told: &Told) {
        match told.direction {
            Direction::Lift => self.lift.learn(told, LIFT_ERROR),
            Direction::Lower => self.lower.learn(told, LOWER_ERROR),
        }
    }
}

impl Belief {
    const fn first(offset: MilliAmp) -> Self {
        Self {
            offset,
            doubt: FIRST_DOUBT,
        }
    }

    /// Share of what is missing that the present doubt makes of it, in thousandths; none of what no offset makes.
    fn share(&self, told: &Told, flow_error: i32) -> i32 {
        let sensitivity = told.sensitivity.0;
        let of_doubt = square(mul_div(sensitivity, self.doubt.0, Divisor::THOUSAND));
        let of_flow = square(mul_div(told.expected.0, flow_error, Divisor::THOUSAND));
        let all = of_doubt
            .saturating_add(of_flow)
            .saturating_add(square(NOISE.0));
        if sensitivity <= 0 || square(told.missing.0 / BELIEVABLE) > all {
            return 0;
        }
        // All is 90 thousandths at least.
        let share = of_doubt.checked_div(all / 1000).unwrap_or(0).min(1000);
        share.cast_signed()
    }

    fn learn(&mut self, told: &Told, flow_error: i32) {
        let mut share = self.share(told, flow_error);
        if share == 0 && told.missing < Micrometre::ZERO {
            self.doubt = FIRST_DOUBT;
            share = self.share(told, flow_error);
        }
        let sensitivity = told.sensitivity.0;
        // um * 1/1000 over um/A is mA.
        let further = mul_div(told.missing.0, share, Divisor::at_least_one(sensitivity));
        self.offset = (self.offset + MilliAmp(further)).limited(-MOST, MOST);
        let left = u64::from(1000_u32.saturating_sub(share.cast_unsigned())).saturating_mul(1000);
        self.doubt =
            MilliAmp(mul_div(self.doubt.0, square_root(left), Divisor::THOUSAND)).max(LEAST_DOUBT);
    }
}

/// Square of a distance in um; three of them fit. Further off than this is no offset anyway.
fn square(value: i32) -> u32 {
    const FAR: u32 = 30_000;
    value.unsigned_abs().min(FAR).pow(2)
}

#[cfg(test)]
mod tests {
    use hitch_quantities::ValidCalibration;
    use hitch_quantities::units::{MilliDegree, Millisecond};

    use super::*;
    use crate::commissioning::teach::Taught;

    /// A lift of `way` um by the curve whose valve is `off_ma` off, and whose flow is wrong by `error`.
    fn lift(way: i32, off_ma: i32, error: f64) -> Told {
        // The rig's lift valve, half of the way on its slope.
        let sensitivity = way / 2;
        let missing = f64::from(off_ma) * 1e-3 * f64::from(sensitivity) + error * f64::from(way);
        Told {
            direction: Direction::Lift,
            expected: Micrometre(way),
            missing: Micrometre(missing as i32),
            sensitivity: Micrometre(sensitivity),
            sensitivity_nl: sensitivity.saturating_mul(4_537),
        }
    }

    #[test]
    fn a_few_short_moves_tell_how_far_a_valve_is_off() {
        for off_ma in [-100, -40, 0, 40, 100] {
            let mut offsets = Offsets::default();
            for _ in 0..6 {
                let left_ma = off_ma - offsets.lift().0;
                offsets.learn(&lift(12_000, left_ma, 0.0));
            }
            let error_ma = (offsets.lift().0 - off_ma).abs();
            assert!(error_ma <= LEAST_DOUBT.0, "{off_ma} mA: {error_ma} off");
            assert_eq!(offsets.lower(), MilliAmp::ZERO);
        }
    }

    #[test]
    fn an_error_of_the_flow_over_a_long_way_is_hardly_blamed_on_the_threshold() {
        let mut offsets = Offsets::default();
        let told = lift(100_000, 0, 0.025);
        // Blamed altogether it would be 50 mA.
        let blamed = offsets.blamed(&told);
        assert!(blamed.0 < told.missing.0 * 7 / 10, "{blamed:?}");
        offsets.learn(&told);
        let learnt = offsets.lift() - FIRST_LIFT;
        assert!(learnt.0 < 35, "{learnt:?}");
    }

    #[test]
    fn a_way_that_is_far_too_long_brings_all_doubt_back() {
        let mut offsets = Offsets::default();
        for _ in 0..6 {
            offsets.learn(&lift(12_000, 80 - offsets.lift().0, 0.0));
        }
        let before = offsets.lift();
        offsets.learn(&lift(12_000, -240, 0.0));
        assert!(offsets.lift() < before - MilliAmp(60), "{offsets:?}");
    }

    #[test]
    fn an_obstacle_and_extremes_teach_nothing_that_is_not_bounded() {
        let mut offsets = Offsets::default();
        offsets.learn(&Told {
            missing: Micrometre(12_000),
            ..lift(12_000, 0, 0.0)
        });
        assert_eq!(offsets.lift(), FIRST_LIFT, "stood in the way");
        for missing in [i32::MIN, -900, 900, i32::MAX] {
            for sensitivity in [i32::MIN, 0, 1, 6_000, i32::MAX] {
                offsets.learn(&Told {
                    missing: Micrometre(missing),
                    sensitivity: Micrometre(sensitivity),
                    ..lift(i32::MAX, 0, 0.0)
                });
                assert!(offsets.lift().magnitude() <= MOST);
            }
        }
    }

    #[test]
    fn a_taught_lift_valve_opens_where_teaching_found() {
        let nominal = ValidCalibration::nominal();
        for shift in [-100, 0, 100].map(MilliAmp) {
            let found = Taught {
                lift_shift: shift,
                lower_shift: shift,
                lift_lag: Millisecond(40),
                lower_lag: Millisecond(40),
                hysteresis: MilliAmp(80),
                lower_end: MilliDegree(44_100),
                upper_end: MilliDegree(135_900),
            };
            let (taught, first) = (found.applied_to(&nominal), Offsets::default());
            let opens = [
                taught.lift.threshold() + first.lift(),
                taught.lower.threshold() + first.lower(),
            ];
            let found = [&nominal.lift, &nominal.lower].map(|table| table.threshold() + shift);
            assert_eq!(opens, found);
        }
    }
}
