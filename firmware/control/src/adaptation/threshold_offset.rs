//! Threshold offsets of this machine's valves, identified from the distances of its moves
//! ([`crate::estimation::move_record`]).
//!
//! Valves of one kind differ by 0.1 A in their threshold, and hysteresis adds half of its width. The other causes of a
//! distance error (oil, load, droop of the compensator) grow with the distance, and the sensor noise is constant, so
//! short moves identify the offset. The correction is that of a Kalman filter of one state:
//!
//! ```text
//! a = sigma * sensitivity     gain = a^2 / (a^2 + noise^2 + (flow error * distance)^2)     sigma^2 *= 1 - gain
//! ```
//!
//! An offset changes only at rest, is bounded, and is lost with the supply. An undershoot beyond three sigmas is an
//! obstacle and is ignored. An overshoot of that size cannot have an external cause: the estimate was wrong, and its
//! sigma is reset.

use hitch_quantities::CoilCurrents;
use hitch_quantities::fixed::{Divisor, mul_div, square_root};
use hitch_quantities::units::{Micrometre, MilliAmp};

use crate::estimation::move_record::MoveRecord;
use crate::valve::phase::Direction;

/// Furthest that a valve may be off: one that is further off has to be taught.
const MAX_OFFSET: MilliAmp = MilliAmp(160);
/// Initial offset of the lift valve. The curve is the mean of both branches of the hysteresis, of which one half
/// usually is 60 mA. The calibrated closing curve compensates the most of it.
pub const INITIAL_LIFT_OFFSET: MilliAmp = MilliAmp(20);
/// Initial sigma: spread of thresholds, and half of the hysteresis.
const INITIAL_SIGMA: MilliAmp = MilliAmp(70);
/// Smallest sigma: coil temperature and hysteresis.
const MIN_SIGMA: MilliAmp = MilliAmp(20);
/// Sigma of the flow error of a lift, in thousandths: the flow is pressure compensated.
const LIFT_ERROR: i32 = 25;
/// Sigma of the flow error of a lowering, in thousandths: load, oil and piston friction are not known well.
const LOWER_ERROR: i32 = 150;
/// A larger error, in sigmas, is an outlier.
const OUTLIER_SIGMAS: i32 = 3;

/// Threshold offsets of both valves.
#[derive(Clone, Copy, Debug)]
pub struct ThresholdOffsets {
    lift: KalmanEstimate,
    lower: KalmanEstimate,
}

impl Default for ThresholdOffsets {
    fn default() -> Self {
        Self {
            lift: KalmanEstimate::new(INITIAL_LIFT_OFFSET),
            lower: KalmanEstimate::new(MilliAmp::ZERO),
        }
    }
}

/// Estimate of an offset with its standard deviation.
#[derive(Clone, Copy, Debug)]
struct KalmanEstimate {
    offset: MilliAmp,
    sigma: MilliAmp,
}

impl ThresholdOffsets {
    /// Threshold offset of the lift valve.
    #[must_use]
    pub const fn lift(&self) -> MilliAmp {
        self.lift.offset
    }

    /// Threshold offset of the lowering valve.
    #[must_use]
    pub const fn lower(&self) -> MilliAmp {
        self.lower.offset
    }

    /// The currents of the nominal curves that give the same flow.
    #[must_use]
    pub fn to_nominal_currents(&self, currents: CoilCurrents) -> CoilCurrents {
        CoilCurrents {
            lift: currents.lift - self.lift.offset,
            lower: currents.lower - self.lower.offset,
        }
    }

    /// Part of the distance error that is attributed to the threshold offset. `noise`: see [`Self::learn`].
    #[must_use]
    pub fn attributed_to_offset(&self, record: &MoveRecord, noise: Micrometre) -> Micrometre {
        let gain = match record.direction {
            Direction::Lift => self.lift.gain(record, LIFT_ERROR, noise),
            Direction::Lower => self.lower.gain(record, LOWER_ERROR, noise),
        };
        record.missing.scaled(gain, Divisor::THOUSAND)
    }

    /// Takes in the record of a move. `noise`: sigma of the distance error that does not depend on the distance
    /// ([`crate::estimation::travel_distances`]).
    pub fn learn(&mut self, record: &MoveRecord, noise: Micrometre) {
        match record.direction {
            Direction::Lift => self.lift.learn(record, LIFT_ERROR, noise),
            Direction::Lower => self.lower.learn(record, LOWER_ERROR, noise),
        }
    }
}

impl KalmanEstimate {
    const fn new(offset: MilliAmp) -> Self {
        Self {
            offset,
            sigma: INITIAL_SIGMA,
        }
    }

    /// Kalman gain in thousandths; zero for an outlier.
    fn gain(&self, record: &MoveRecord, flow_error: i32, noise: Micrometre) -> i32 {
        let sensitivity = record.sensitivity.0;
        let of_sigma = square(mul_div(sensitivity, self.sigma.0, Divisor::THOUSAND));
        let of_flow = square(mul_div(record.expected.0, flow_error, Divisor::THOUSAND));
        let all = of_sigma
            .saturating_add(of_flow)
            .saturating_add(square(noise.0));
        if sensitivity <= 0 || square(record.missing.0 / OUTLIER_SIGMAS) > all {
            return 0;
        }
        let gain = of_sigma.checked_div(all / 1000).unwrap_or(0).min(1000);
        gain.cast_signed()
    }

    fn learn(&mut self, record: &MoveRecord, flow_error: i32, noise: Micrometre) {
        let mut gain = self.gain(record, flow_error, noise);
        if gain == 0 && record.missing < Micrometre::ZERO {
            self.sigma = INITIAL_SIGMA;
            gain = self.gain(record, flow_error, noise);
        }
        let sensitivity = record.sensitivity.0;
        // um * 1/1000 over um/A is mA.
        let correction = mul_div(record.missing.0, gain, Divisor::at_least_one(sensitivity));
        self.offset = (self.offset + MilliAmp(correction)).limited(-MAX_OFFSET, MAX_OFFSET);
        let remaining =
            u64::from(1000_u32.saturating_sub(gain.cast_unsigned())).saturating_mul(1000);
        self.sigma = MilliAmp(mul_div(
            self.sigma.0,
            square_root(remaining),
            Divisor::THOUSAND,
        ))
        .max(MIN_SIGMA);
    }
}

/// Square of a distance in um, limited so that the sum of three fits.
fn square(value: i32) -> u32 {
    const MAX_DISTANCE: u32 = 30_000;
    value.unsigned_abs().min(MAX_DISTANCE).pow(2)
}

#[cfg(test)]
mod tests {
    use hitch_quantities::ValidCalibration;
    use hitch_quantities::units::{MilliDegree, Millisecond};

    use super::*;
    const NOISE: Micrometre = Micrometre(300);
    use crate::commissioning::teach::Taught;

    /// A lift of `way` um by the curve whose valve is `off_ma` off, and whose flow is wrong by `error`.
    fn lift(way: i32, off_ma: i32, error: f64) -> MoveRecord {
        // The rig's lift valve, half of the way on its slope.
        let sensitivity = way / 2;
        let missing = f64::from(off_ma) * 1e-3 * f64::from(sensitivity) + error * f64::from(way);
        MoveRecord {
            direction: Direction::Lift,
            expected: Micrometre(way),
            missing: Micrometre(missing as i32),
            sensitivity: Micrometre(sensitivity),
            sensitivity_nl: sensitivity.saturating_mul(4_537),
        }
    }

    #[test]
    fn a_few_short_moves_identify_the_offset() {
        for off_ma in [-100, -40, 0, 40, 100] {
            let mut offsets = ThresholdOffsets::default();
            for _ in 0..6 {
                let left_ma = off_ma - offsets.lift().0;
                offsets.learn(&lift(12_000, left_ma, 0.0), NOISE);
            }
            let error_ma = (offsets.lift().0 - off_ma).abs();
            assert!(error_ma <= MIN_SIGMA.0, "{off_ma} mA: {error_ma} off");
            assert_eq!(offsets.lower(), MilliAmp::ZERO);
        }
    }

    #[test]
    fn a_flow_error_over_a_long_distance_is_hardly_attributed_to_the_threshold() {
        let mut offsets = ThresholdOffsets::default();
        let record = lift(100_000, 0, 0.025);
        // Blamed altogether it would be 50 mA.
        let attributed = offsets.attributed_to_offset(&record, NOISE);
        assert!(attributed.0 < record.missing.0 * 7 / 10, "{attributed:?}");
        offsets.learn(&record, NOISE);
        let learnt = offsets.lift() - INITIAL_LIFT_OFFSET;
        assert!(learnt.0 < 35, "{learnt:?}");
    }

    #[test]
    fn a_large_overshoot_resets_the_sigma() {
        let mut offsets = ThresholdOffsets::default();
        for _ in 0..6 {
            offsets.learn(&lift(12_000, 80 - offsets.lift().0, 0.0), NOISE);
        }
        let before = offsets.lift();
        offsets.learn(&lift(12_000, -240, 0.0), NOISE);
        assert!(offsets.lift() < before - MilliAmp(60), "{offsets:?}");
    }

    #[test]
    fn obstacles_are_ignored_and_extremes_stay_bounded() {
        let mut offsets = ThresholdOffsets::default();
        offsets.learn(
            &MoveRecord {
                missing: Micrometre(12_000),
                ..lift(12_000, 0, 0.0)
            },
            NOISE,
        );
        assert_eq!(offsets.lift(), INITIAL_LIFT_OFFSET, "stood in the way");
        for missing in [i32::MIN, -900, 900, i32::MAX] {
            for sensitivity in [i32::MIN, 0, 1, 6_000, i32::MAX] {
                offsets.learn(
                    &MoveRecord {
                        missing: Micrometre(missing),
                        sensitivity: Micrometre(sensitivity),
                        ..lift(i32::MAX, 0, 0.0)
                    },
                    NOISE,
                );
                assert!(offsets.lift().magnitude() <= MAX_OFFSET);
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
            let (taught, first) = (found.applied_to(&nominal), ThresholdOffsets::default());
            let opens = [
                taught.lift.threshold() + first.lift(),
                taught.lower.threshold() + first.lower(),
            ];
            let found = [&nominal.lift, &nominal.lower].map(|table| table.threshold() + shift);
            assert_eq!(opens, found);
        }
    }
}
