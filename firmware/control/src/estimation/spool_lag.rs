//! Identifies the lag of this machine's spools from the position error during a move.
//!
//! A spool that is slower by `dT` than its model causes a position error of `dT v`, where `v` is the speed that the
//! opening gives. So the lag is a weighted least-squares estimate at any time of a move:
//!
//! ```text
//! dT = sum(v error) / (sum(v^2) + W)      W: weight of earlier moves; initially the spread of valves
//! ```
//!
//! The estimate is available early enough to brake the same move, and is kept for the next one. It contains the lag of
//! the sensor, as braking requires. A hitch without any additional lag still has a usual position error, because its
//! load has to be accelerated.
//!
//! A flow error causes a permanent position error, a lag a transient one. The position error at rest therefore gives
//! the part of the error that was not caused by the lag: a flow error grows with the distance `x`, a threshold error
//! with the sensitivity `s`.

use hitch_quantities::calibration::design_parameters::HydraulicParameters;
use hitch_quantities::fixed::{Divisor, mul_div};
use hitch_quantities::units::{MicroLitrePerSecond, Micrometre, MicrometrePerSecond, Millisecond};

use super::millisecond_q3::MillisecondQ3;
use super::move_record::MoveRecord;

/// Sum of squares at which the regression of a move is complete: 20 ms at full speed.
const COMPLETE_SUM: i32 = 400_000;
/// Initial weight, as such a sum: the lags of valves differ by some 10 ms.
const INITIAL_WEIGHT: i32 = 50_000;
/// Largest weight of earlier moves: the oil temperature changes.
const MAX_WEIGHT: i32 = 200_000;

/// Lags of lift and lowering valve in the calibration.
#[must_use]
pub const fn nominal_lags(hydraulics: &HydraulicParameters) -> [Millisecond; 2] {
    [hydraulics.spool_lag, hydraulics.lower_spool_lag]
}

/// Estimate of the lag of a spool in excess of the calibration, with its weight.
#[derive(Clone, Copy, Debug)]
pub struct SpoolLagEstimator {
    additional_lag: MillisecondQ3,
    weight: i32,
}

impl Default for SpoolLagEstimator {
    fn default() -> Self {
        Self {
            additional_lag: MillisecondQ3(0),
            weight: INITIAL_WEIGHT,
        }
    }
}

impl SpoolLagEstimator {
    /// Additional lag.
    #[must_use]
    pub const fn additional_lag(&self) -> MillisecondQ3 {
        self.additional_lag
    }

    /// Additional lag, if moves of this valve have identified it; otherwise zero.
    #[must_use]
    pub fn identified(&self) -> MillisecondQ3 {
        if self.weight > INITIAL_WEIGHT {
            self.additional_lag
        } else {
            MillisecondQ3(0)
        }
    }

    /// Takes in the regression of a finished move. `limit`: largest magnitude of the additional lag.
    pub fn learn(&mut self, regression: &LagRegression, limit: MillisecondQ3) {
        self.additional_lag =
            (self.additional_lag + regression.additional_lag(*self, limit)).limited(limit);
        self.weight = self
            .weight
            .saturating_add(regression.speed_squared)
            .min(MAX_WEIGHT);
    }

    /// Both valves are of one kind: the other one's estimate is the initial value until a move of this valve identifies
    /// it.
    pub fn initialize_from(&mut self, other: Self) {
        if self.weight == INITIAL_WEIGHT {
            self.additional_lag = other.additional_lag;
        }
    }
}

/// Regression of position error over speed during a move. Distances are in 1.024 um and speeds in 1.024 mm/s, so that
/// conversion is a shift; times stay in milliseconds.
#[derive(Clone, Copy, Debug, Default)]
pub struct LagRegression {
    from_nm: i32,
    /// Position by the valve model, nm.
    expected_nm: i32,
    /// Volume error for each ampere of threshold offset, nl/A.
    sensitivity_nl: i32,
    /// Sum of speed times sensitivity, in 2048 nl/A.
    speed_sensitivity: i32,
    /// Sum of speed times position error, Q3.
    speed_error: i32,
    speed_squared: i32,
}

impl LagRegression {
    /// Starts a move at this position.
    #[must_use]
    pub fn from(position_nm: i32) -> Self {
        Self {
            from_nm: position_nm,
            expected_nm: position_nm,
            ..Self::default()
        }
    }

    /// One step. `model`: speed of the valve model; `slope`: its change with the current; `usual`: lag of a hitch
    /// without additional spool lag.
    pub fn step(
        &mut self,
        measured_nm: i32,
        model: MicrometrePerSecond,
        slope: MicroLitrePerSecond,
        usual: MillisecondQ3,
    ) {
        if self.is_complete() {
            return;
        }
        self.expected_nm = self.expected_nm.saturating_add(model.0);
        self.sensitivity_nl = self.sensitivity_nl.saturating_add(slope.0);
        let speed = model.0 >> 10;
        let of_ampere = speed.wrapping_mul(self.sensitivity_nl >> 11);
        self.speed_sensitivity = self.speed_sensitivity.saturating_add(of_ampere);
        let error = self.expected_nm.saturating_sub(measured_nm) >> 7;
        let additional_lag = error.saturating_sub(speed.wrapping_mul(usual.0));
        // An error of 16 mm at 400 mm/s fits. Impossible values may wrap.
        self.speed_error = self
            .speed_error
            .saturating_add(speed.wrapping_mul(additional_lag));
        self.speed_squared = self
            .speed_squared
            .saturating_add(speed.wrapping_mul(speed).max(0));
    }

    const fn is_complete(&self) -> bool {
        self.speed_squared >= COMPLETE_SUM
    }

    /// Removes the errors that were not caused by the lag, after the move: `of_offset` of the distance error is caused
    /// by the threshold, the rest by the flow.
    ///
    /// The flow error grows with the distance. Its product with the speed is the integral of `v x / x_end` up to the
    /// end of the sums, `x^2 / 2 x_end`.
    pub fn correct(&mut self, record: &MoveRecord, of_offset: Micrometre) {
        let distance = Divisor::THOUSAND.divide(self.expected_nm.saturating_sub(self.from_nm));
        let distance = distance.saturating_abs();
        let of_flow = record.missing - of_offset;
        // Q3 times 1/2.
        let grown = mul_div(
            of_flow.0,
            distance,
            Divisor::at_least_one(record.expected.0),
        );
        let by_flow = grown.saturating_mul(distance).saturating_mul(4);
        // The values are some thousand um/ms: the rounding error is far below a millisecond.
        let weighted =
            Divisor::at_least_one(record.sensitivity_nl >> 11).divide(self.speed_sensitivity);
        let by_offset = of_offset
            .0
            .saturating_mul(weighted.saturating_abs())
            .saturating_mul(8);
        self.speed_error = self
            .speed_error
            .saturating_sub(by_flow)
            .saturating_sub(by_offset);
    }

    /// Correction of the estimate `lag`.
    #[must_use]
    pub fn additional_lag(&self, lag: SpoolLagEstimator, limit: MillisecondQ3) -> MillisecondQ3 {
        let weight = self.speed_squared.saturating_add(lag.weight);
        MillisecondQ3(Divisor::at_least_one(weight).divide(self.speed_error)).limited(limit)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::valve::phase::Direction;

    const LIMIT: MillisecondQ3 = MillisecondQ3(8 * 35);

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
        /// Additional lag by the first move, at rest and 20 ms into the fall of the current, and by the second move.
        fn identified_ms(&self) -> [f64; 3] {
            let mut lag = SpoolLagEstimator::default();
            let mut record = [0.0; 3];
            for move_index in 0..2 {
                let mut regression = LagRegression::from(5_000_000);
                let end = self.drive(&mut regression, lag, |regression| {
                    if move_index == 0 {
                        record[0] = f64::from(regression.additional_lag(lag, LIMIT).0) / 8.0;
                    }
                });
                let late = self.late * f64::from(end.sensitivity_nl) / f64::from(SLOPE.0) * FULL;
                regression.correct(&end, Micrometre((late * 1e-3) as i32));
                lag.learn(&regression, LIMIT);
                record[move_index + 1] = f64::from(lag.additional_lag().0) / 8.0;
            }
            record
        }

        /// The whole move; `falling` sees it 20 ms into its fall.
        fn drive(
            &self,
            regression: &mut LagRegression,
            lag: SpoolLagEstimator,
            mut falling: impl FnMut(&LagRegression),
        ) -> MoveRecord {
            let lag_ms = 40.0 + f64::from(lag.additional_lag().0) / 8.0;
            let (mut model, mut truth) = (0.0, 0.0);
            let (mut expected_nm, mut way_nm, mut sensitivity_nl) = (0.0, 0.0, 0);
            for ms in 0..self.hold_ms + 700 {
                let fall = f64::from((ms - self.hold_ms - 40).max(0)) / 100.0;
                let opening = self.speed * ((f64::from(ms) / 40.0).min(1.0) - fall).max(0.0);
                model += (opening - model) / lag_ms;
                truth += (opening - truth) / (40.0 + self.slower_ms);
                let flow = flow(model);
                let slope = if flow > 0.0 && flow < OPEN {
                    SLOPE
                } else {
                    MicroLitrePerSecond::ZERO
                };
                expected_nm += flow;
                way_nm += self::flow(truth - self.late * FULL) * (1.0 + self.flow_error);
                sensitivity_nl += slope.0;
                let place_nm = 5_000_000 + way_nm as i32;
                let flow = MicrometrePerSecond(flow as i32);
                regression.step(place_nm, flow, slope, MillisecondQ3(0));
                if ms == self.hold_ms + 60 {
                    falling(regression);
                }
            }
            MoveRecord {
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
    fn a_move_identifies_the_lag_of_its_spool_before_braking() {
        for slower_ms in [-15.0, -7.0, 0.0, 7.0, 15.0_f64] {
            for (speed, hold_ms) in [(60_000.0, 30), (100_000.0, 100), (FULL, 400)] {
                for flow_error in [-0.05, 0.0, 0.05] {
                    let record = Lift {
                        speed,
                        hold_ms,
                        flow_error,
                        slower_ms,
                        late: 0.0,
                    }
                    .identified_ms();
                    // A third is identified while spool and load still follow, the rest by the next moves.
                    for (lag_ms, share) in record.into_iter().zip([0.7, 0.7, 0.5]) {
                        let error_ms = (lag_ms - slower_ms).abs();
                        assert!(
                            error_ms <= 2.0 + share * slower_ms.abs() + 80.0 * flow_error.abs(),
                            "{slower_ms} ms at {speed} um/s, flow {flow_error}: {record:?}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn a_threshold_offset_is_not_taken_for_a_lag() {
        for late in [-0.05, 0.05] {
            for (speed, hold_ms) in [(60_000.0, 30), (100_000.0, 100), (FULL, 100)] {
                let record = Lift {
                    speed,
                    hold_ms,
                    flow_error: 0.0,
                    slower_ms: 0.0,
                    late,
                }
                .identified_ms();
                assert!(record[0] * late > 0.0, "seems slow on the way: {record:?}");
                assert!(
                    record[1..].iter().all(|lag_ms| lag_ms.abs() <= 4.0),
                    "{late} late at {speed} um/s: {record:?}"
                );
            }
        }
    }

    #[test]
    fn one_valve_initializes_the_other_until_that_one_moves() {
        let (mut lift, mut lower) = (SpoolLagEstimator::default(), SpoolLagEstimator::default());
        let late = LagRegression {
            speed_error: 8 * 10 * COMPLETE_SUM,
            speed_squared: COMPLETE_SUM,
            ..LagRegression::default()
        };
        lift.learn(&late, LIMIT);
        lower.initialize_from(lift);
        assert_eq!(lower.additional_lag(), lift.additional_lag());
        assert_eq!(
            lower.identified(),
            MillisecondQ3(0),
            "not identified by its own moves"
        );
        assert!((60..=80).contains(&lift.additional_lag().0), "{lift:?}");
        lower.learn(&LagRegression::default(), LIMIT);
        lower.learn(&late, LIMIT);
        assert_eq!(lower.identified(), lower.additional_lag());
        let before = lower.additional_lag();
        lower.initialize_from(SpoolLagEstimator::default());
        assert_eq!(lower.additional_lag(), before);
    }

    #[test]
    fn extremes_stay_within_the_limit() {
        for place_nm in [i32::MIN, 0, i32::MAX] {
            for speed in [i32::MIN, -300_000, 0, 300_000, i32::MAX] {
                let mut regression = LagRegression::from(place_nm);
                let mut lag = SpoolLagEstimator::default();
                for _ in 0..1_000 {
                    let model = MicrometrePerSecond(speed);
                    let slope = MicroLitrePerSecond(place_nm);
                    regression.step(
                        -place_nm.saturating_add(1),
                        model,
                        slope,
                        MillisecondQ3(800),
                    );
                }
                for missing in [i32::MIN, i32::MAX] {
                    let record = MoveRecord {
                        direction: Direction::Lower,
                        expected: Micrometre(i32::MAX),
                        missing: Micrometre(missing),
                        sensitivity: Micrometre(0),
                        sensitivity_nl: missing,
                    };
                    regression.correct(&record, Micrometre(place_nm));
                    lag.learn(&regression, LIMIT);
                    assert!(lag.additional_lag().0.abs() <= LIMIT.0);
                }
            }
        }
    }
}
