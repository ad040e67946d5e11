//! Position law: from the distance to the target to the demanded piston speed.
//!
//! The controlled variable is the predicted stop of the hitch ([`StopPrediction::predicted_stop`]). It moves with
//! exactly the demanded speed, so a speed profile that falls to zero with the remaining distance `r` arrives without
//! overshoot. The profile has a constant deceleration `a`, and a linear end with the gain `k`:
//!
//! ```text
//! u(r) = k r                        r <= a / k^2
//! u(r) = sqrt(2 a (r - a / 2k^2))   above; value and slope are continuous
//! ```
//!
//! The demand is never below the creep speed. The approach ends with a cut of the coil, from which the closing spool
//! carries the hitch to the set point ([`StopPrediction::predicted_stop_after_cut`]). A load that stops from a speed
//! `v` oscillates on its oil with the amplitude `v / w`, so the creep speed is low. The creep phase lies within the
//! tolerance of half a degree, so it does not delay the move. A correction runs at a multiple of the creep speed.
//!
//! A load that oscillates backwards before the cut seems to have distance left. Reopening the valve for that would
//! excite the next oscillation and cause an overshoot. Therefore a move does not accelerate again once the final
//! approach has begun.

use hitch_quantities::Calibration;
use hitch_quantities::calibration::design_parameters::PositionParameters;
use hitch_quantities::fixed::{Divisor, mul_div, square_root};
use hitch_quantities::units::{
    Micrometre, MicrometrePerSecond, MilliDegree, MillimetrePerSecondSquared, Millisecond,
    PerSecond,
};

use super::bands::Bands;
use super::stop_band;
use crate::estimation::motion_observer::MotionObserver;
use crate::estimation::stop_prediction::StopPrediction;
use crate::valve::closing::ClosingCurves;
use crate::valve::drop_scale::DropScale;
use crate::valve::phase::{Demand, Direction, Phase};

/// Speed limit of a correction, in creep speeds: at the creep speed it would take seconds.
const CORRECTION_FACTOR: i32 = 3;
/// Speed limit of the final approach, in creep speeds: the remaining distance is half a millimetre.
const FINAL_APPROACH_FACTOR: i32 = 6;
/// The position controller.
#[derive(Clone, Copy, Debug, Default)]
pub struct PositionControl {
    set_point: Option<MilliDegree>,
    /// Taken over with the set point.
    bands: Option<Bands>,
    /// Set point for which the state below holds. The one in use is within the dead band of it.
    reference_set_point: MilliDegree,
    /// The hitch has been at rest at this set point: a later deviation is drift.
    arrived: bool,
    /// A move to this set point has begun: the next one is a correction.
    started: bool,
    /// The present move corrects a move that has missed its set point.
    is_correction: bool,
    /// How far corrections to this set point go beyond their predicted stop, and the direction of the last one.
    beyond: Micrometre,
    corrected: Option<Direction>,
    /// Duration of the final approach of the present move.
    approach_time: Millisecond,
    /// The present position counts as the set point until the lever moves (end stop).
    accepted: bool,
}

/// Reason for which a hitch at rest moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MoveReason {
    /// The lever was moved.
    SetPoint,
    /// The hitch has drifted.
    Drift,
}

impl PositionControl {
    /// Takes in the lever and its upper limit. True if that is a new set point.
    ///
    /// During a move to a set point every movement of the lever changes the target, but small ones do not reset the
    /// state. After arrival, and during corrections, small movements are noise.
    pub fn follow(
        &mut self,
        lever: MilliDegree,
        upper_limit: MilliDegree,
        moving: bool,
        parameters: &PositionParameters,
    ) -> bool {
        let lever = lever.limited(parameters.lower_limit, upper_limit);
        let deadband = self.bands(parameters).lever_deadband;
        let changed =
            self.set_point.is_none() || (lever - self.reference_set_point).magnitude() > deadband;
        if changed {
            *self = Self {
                set_point: Some(lever),
                bands: Some(Bands::of(parameters)),
                reference_set_point: lever,
                ..Self::default()
            };
        } else if moving && !self.arrived {
            self.set_point = Some(lever);
        }
        changed
    }

    /// The bands of the present set point; those of `parameters` before there is one.
    #[must_use]
    pub fn bands(&self, parameters: &PositionParameters) -> Bands {
        self.bands.unwrap_or(Bands::of(parameters))
    }

    /// The set point inside the limits; `otherwise` before there was one.
    #[must_use]
    pub fn set_point(&self, otherwise: MilliDegree) -> MilliDegree {
        self.set_point.unwrap_or(otherwise)
    }

    /// Another law has moved the hitch about its set point: the next move is one to the set point.
    pub fn begin_anew(&mut self) {
        (self.arrived, self.started, self.accepted) = (false, false, false);
    }

    /// Accepts the present position as the set point until the lever moves.
    pub fn accept(&mut self) {
        self.accepted = true;
    }

    /// True if the hitch has been at rest at the set point.
    #[must_use]
    pub const fn has_arrived(&self) -> bool {
        self.arrived
    }

    /// True if the next move, if any, is no longer that to the set point of the lever.
    #[must_use]
    pub fn has_moved(&self) -> bool {
        self.reason() == MoveReason::Drift
    }

    /// The reason for which a hitch at rest has to move to `target`, if there is one.
    pub fn reason_to_move(
        &mut self,
        target: Micrometre,
        rest: Micrometre,
        parameters: &PositionParameters,
    ) -> Option<MoveReason> {
        if self.accepted || (target - rest).magnitude() <= self.bands(parameters).restart_band {
            self.arrived = true;
            return None;
        }
        Some(self.reason())
    }

    /// A correction starts in this direction, from a hitch at rest `away` from the set point. If the last one was in the
    /// other direction, it has gone too far. The observer has not seen why: the correction is a hundred milliseconds long,
    /// and its valve opens by a threshold that it does not know. The next one therefore ends earlier by as much. Without
    /// this a hitch moves back and forth about its set point until its corrections are spent.
    pub fn begin_correction(
        &mut self,
        direction: Direction,
        away: Micrometre,
        parameters: &PositionParameters,
    ) {
        let away = away.magnitude();
        self.beyond = match self.corrected {
            Some(last) if last != direction => {
                let limit = self.bands(parameters).restart_band - parameters.stop_band;
                (self.beyond + away).min(limit.max(Micrometre::ZERO))
            }
            Some(_) => (self.beyond - away).max(Micrometre::ZERO),
            None => Micrometre::ZERO,
        };
        self.corrected = Some(direction);
    }

    /// A move starts; the reason for it.
    pub fn start(&mut self) -> MoveReason {
        let reason = self.reason();
        self.is_correction = self.started && !self.arrived;
        self.started = true;
        self.approach_time = Millisecond::ZERO;
        reason
    }

    const fn reason(&self) -> MoveReason {
        if self.arrived || self.started {
            MoveReason::Drift
        } else {
            MoveReason::SetPoint
        }
    }

    /// The demand of a move to `target`.
    #[must_use]
    pub fn demand(
        &self,
        target: Micrometre,
        phase: Phase,
        motion: &MotionObserver,
        closing: &ClosingCurves,
        scale: DropScale,
        calibration: &Calibration,
    ) -> Demand {
        let parameters = &calibration.position;
        let direction = match phase {
            Phase::Moving { direction, .. } => direction,
            _ => Direction::of((target - motion.position()).0),
        };
        let (limit, acceleration, deceleration) = match direction {
            Direction::Lift if motion.has_compensator_oscillation() => (
                parameters.lift_speed,
                parameters.swinging_acceleration,
                parameters.swinging_deceleration,
            ),
            Direction::Lift => (
                parameters.lift_speed,
                parameters.lift_acceleration,
                parameters.lift_deceleration,
            ),
            Direction::Lower => (
                parameters.lower_speed,
                scale.ramp_at_present(parameters.lower_acceleration),
                scale.ramp_at_present(parameters.lower_deceleration),
            ),
        };
        let ahead_of = |point: Micrometre| Micrometre(direction.sign((target - point).0));
        let stop_prediction: StopPrediction = motion.stop_prediction(&calibration.hydraulics);
        let ahead_of = |point: Micrometre| ahead_of(point) - self.beyond;
        let remaining = ahead_of(stop_prediction.predicted_stop());
        // The stopping distance after a cut is shorter than that of a ramp, so the ramp is checked first.
        let band = stop_band::after(self.approach_time, parameters);
        let cut = remaining <= band
            && ahead_of(stop_prediction.predicted_stop_after_cut(motion.closing_share(closing)))
                <= band;
        let approach = approach_speed(remaining, deceleration, parameters.approach_gain);
        let speed = if cut {
            MicrometrePerSecond::ZERO
        } else {
            approach.max(parameters.creep_speed).min(limit)
        };
        Demand {
            direction,
            speed,
            acceleration,
        }
    }

    /// Limits the `demand` in the final approach and in a correction.
    ///
    /// The cause of a missed set point is unknown to the observer, and a short correction does not identify it in time:
    /// a fast correction would miss the set point by the same error. A drift after arrival needs no such limit.
    /// `lower_speed`: lowering limit of the operator.
    #[must_use]
    pub fn limit_approach(
        &mut self,
        mut demand: Demand,
        lower_speed: MicrometrePerSecond,
        parameters: &PositionParameters,
    ) -> Demand {
        // A low limit of the dial is no final approach: the dial may be opened during the move.
        let by_dial = demand.direction == Direction::Lower && demand.speed >= lower_speed;
        if by_dial {
            demand.speed = lower_speed;
        }
        let slow = !by_dial && demand.speed <= creep_multiple(FINAL_APPROACH_FACTOR, parameters);
        if slow || self.approach_time > Millisecond::ZERO {
            self.approach_time = self.approach_time.next();
        }
        let times = match (self.is_correction, self.approach_time > Millisecond::ZERO) {
            (true, _) => CORRECTION_FACTOR,
            (false, true) => FINAL_APPROACH_FACTOR,
            (false, false) => return demand,
        };
        demand.speed = demand.speed.min(creep_multiple(times, parameters));
        demand
    }
}

/// A multiple of the creep speed.
fn creep_multiple(times: i32, parameters: &PositionParameters) -> MicrometrePerSecond {
    MicrometrePerSecond(parameters.creep_speed.0.saturating_mul(times))
}

/// The speed profile `u(r)` of the module documentation.
#[must_use]
pub fn approach_speed(
    remaining: Micrometre,
    deceleration: MillimetrePerSecondSquared,
    gain: PerSecond,
) -> MicrometrePerSecond {
    let remaining = remaining.max(Micrometre::ZERO);
    let gain_squared = Divisor::at_least_one(gain.0.saturating_mul(gain.0));
    let linear = Micrometre(mul_div(deceleration.0, 1000, gain_squared));
    if remaining <= linear {
        return MicrometrePerSecond(remaining.0.saturating_mul(gain.0));
    }
    let beyond = remaining - Micrometre(Divisor::at_least_one(2).divide(linear.0));
    // 2 a r in um2/s2, with a in 1000 um/s2: below 2^32 * 2^15 * 2000 = 2^58.
    let twice = u64::from(deceleration.0.unsigned_abs()).saturating_mul(2000);
    MicrometrePerSecond(square_root(
        twice.saturating_mul(u64::from(beyond.0.unsigned_abs())),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::valve::drop_scale::DropReference;

    #[test]
    fn the_profile_is_the_constant_deceleration_it_says() {
        let (deceleration, gain) = (MillimetrePerSecondSquared(1_200), PerSecond(20));
        let mut last = MicrometrePerSecond::ZERO;
        for remaining in 0..200_000 {
            let speed = approach_speed(Micrometre(remaining), deceleration, gain);
            assert!(speed >= last, "falls at {remaining} um");
            let (r, a, k) = (f64::from(remaining) * 1e-6, 1.2, 20.0);
            let exact = if r <= a / (k * k) {
                k * r
            } else {
                (2.0 * a * (r - a / (2.0 * k * k))).sqrt()
            };
            assert!(
                (f64::from(speed.0) * 1e-6 - exact).abs() < 1e-4 * exact + 2e-6,
                "{remaining} um"
            );
            last = speed;
        }
    }

    #[test]
    fn cutting_the_coil_at_the_slowest_approach_leaves_a_load_on_aerated_oil_where_it_is() {
        // A load that is stopped at once swings on by its speed over its frequency; 1.75 mm are a degree.
        const SOFTEST_HZ: f64 = 5.0;
        let creep_mm_per_s = f64::from(PositionParameters::NOMINAL.creep_speed.0) * 1e-3;
        let swing_mm = creep_mm_per_s / (core::f64::consts::TAU * SOFTEST_HZ);
        assert!(swing_mm / 1.75 <= 0.1, "{swing_mm} mm");
    }

    #[test]
    fn a_move_that_ended_elsewhere_is_made_good_slowly_but_not_as_slowly_as_a_move_ends() {
        let parameters = PositionParameters::NOMINAL;
        let (fast, creep) = (
            parameters.lift_speed,
            creep_multiple(CORRECTION_FACTOR, &parameters),
        );
        assert!(creep > parameters.creep_speed && creep.0 < fast.0 / 10);
        let demand = Demand {
            direction: Direction::Lift,
            speed: fast,
            acceleration: parameters.lift_acceleration,
        };
        let mut position = PositionControl::default();
        let mut moved = |reason, rests| {
            assert_eq!(position.start(), reason);
            if rests {
                let here = Micrometre::ZERO;
                assert_eq!(position.reason_to_move(here, here, &parameters), None);
            }
            position.limit_approach(demand, fast, &parameters).speed
        };
        assert_eq!(moved(MoveReason::SetPoint, false), fast);
        assert_eq!(moved(MoveReason::Drift, true), creep, "ended elsewhere");
        assert_eq!(moved(MoveReason::Drift, false), fast, "left its place");
    }

    #[test]
    fn a_correction_that_went_too_far_makes_the_next_one_end_earlier() {
        let parameters = PositionParameters::NOMINAL;
        let mut position = PositionControl::default();
        let mut beyond = |direction, away| {
            position.begin_correction(direction, Micrometre(away), &parameters);
            position.beyond.0
        };
        let most = (parameters.restart_band - parameters.stop_band).0;
        assert_eq!(beyond(Direction::Lift, 700), 0, "nothing known");
        assert_eq!(beyond(Direction::Lift, 700), 0, "a leak goes on");
        assert_eq!(beyond(Direction::Lower, -300), 300, "too far");
        assert_eq!(beyond(Direction::Lower, -200), 100, "not far enough");
        // A hitch that has to be corrected has more left than the stop band.
        assert_eq!(beyond(Direction::Lift, 5_000), most);
        position.follow(
            parameters.lower_limit,
            parameters.upper_limit,
            false,
            &parameters,
        );
        assert_eq!(position.beyond, Micrometre::ZERO, "another set point");
    }

    #[test]
    fn a_move_that_has_slowed_down_to_its_end_stays_slow_until_the_next_one() {
        let parameters = PositionParameters::NOMINAL;
        let (fast, end) = (
            parameters.lift_speed,
            creep_multiple(FINAL_APPROACH_FACTOR, &parameters),
        );
        let limit_approach = |position: &mut PositionControl, speed| {
            let demand = Demand {
                direction: Direction::Lift,
                speed,
                acceleration: parameters.lift_acceleration,
            };
            position.limit_approach(demand, fast, &parameters).speed
        };
        let (low, high) = (MilliDegree(80_000), MilliDegree(90_000));
        let mut position = PositionControl::default();
        position.follow(low, parameters.upper_limit, false, &parameters);
        position.start();
        for speed in [fast, end + MicrometrePerSecond(1), fast] {
            assert_eq!(limit_approach(&mut position, speed), speed, "under way");
        }
        let slow = parameters.creep_speed;
        for (demanded, given) in [(end, end), (fast, end), (slow, slow), (fast, end)] {
            assert_eq!(limit_approach(&mut position, demanded), given);
        }
        position.follow(high, parameters.upper_limit, true, &parameters);
        assert_eq!(
            limit_approach(&mut position, fast),
            fast,
            "another set point"
        );
        assert_eq!(limit_approach(&mut position, end), end);
        let here = Micrometre::ZERO;
        assert_eq!(position.reason_to_move(here, here, &parameters), None);
        position.start();
        assert_eq!(limit_approach(&mut position, fast), fast, "another move");
    }

    /// For how long a hitch that stands still `short_of` where its coil is cut is waited for, ms.
    fn time_to_cut(position: &mut PositionControl, short_of: Micrometre) -> Option<i32> {
        let calibration = Calibration::nominal();
        let parameters = &calibration.position;
        let closing = ClosingCurves::of(&calibration);
        let drop = calibration.hydraulics.reference_drop;
        let scale = DropScale::new(&DropReference::new(drop), drop);
        let mut motion = MotionObserver::default();
        motion.update(Micrometre::ZERO, None, Phase::Holding, &calibration.motion);
        let phase = Phase::Moving {
            direction: Direction::Lift,
            speed: parameters.creep_speed,
        };
        let target = parameters.stop_band + short_of;
        (0..2_000).find(|_| {
            let demand = position.demand(target, phase, &motion, &closing, scale, &calibration);
            let demand = position.limit_approach(demand, parameters.lower_speed, parameters);
            demand.speed == MicrometrePerSecond::ZERO
        })
    }

    #[test]
    fn a_hitch_that_stands_just_short_of_its_set_point_is_not_waited_for() {
        let mut position = PositionControl::default();
        position.start();
        assert_eq!(time_to_cut(&mut position, Micrometre::ZERO), Some(0));
        let largest = stop_band::largest_extension(&PositionParameters::NOMINAL).0;
        for (short_of, longest_ms) in [(20, 121), (largest, 180)] {
            position.start();
            let waited_ms = time_to_cut(&mut position, Micrometre(short_of)).unwrap();
            assert!((100..=longest_ms).contains(&waited_ms), "{waited_ms} ms");
        }
        position.start();
        assert_eq!(time_to_cut(&mut position, Micrometre(largest + 1)), None);
    }

    #[test]
    fn a_load_that_swings_back_at_the_end_of_a_move_is_waited_for_no_longer() {
        let parameters = PositionParameters::NOMINAL;
        let demand = |speed| Demand {
            direction: Direction::Lift,
            speed,
            acceleration: parameters.lift_acceleration,
        };
        let mut position = PositionControl::default();
        position.start();
        let end = creep_multiple(FINAL_APPROACH_FACTOR, &parameters);
        let _ = position.limit_approach(demand(end), parameters.lower_speed, &parameters);
        for _ in 0..stop_band::delay(&parameters).0 {
            let fast = demand(parameters.lift_speed);
            let _ = position.limit_approach(fast, parameters.lower_speed, &parameters);
        }
        let waited_ms = time_to_cut(&mut position, Micrometre(20)).unwrap();
        assert!(waited_ms <= 10, "{waited_ms} ms more");
    }

    #[test]
    fn a_hitch_that_goes_on_at_its_slowest_gets_where_it_should() {
        let way_per_ms = PositionParameters::NOMINAL.creep_speed.0 / 1_000;
        let end_mm_per_s =
            creep_multiple(FINAL_APPROACH_FACTOR, &PositionParameters::NOMINAL).0 / 1_000;
        let at_end_um = 1_000 * end_mm_per_s / PositionParameters::NOMINAL.approach_gain.0;
        let slowest_um = at_end_um - PositionParameters::NOMINAL.stop_band.0;
        assert!(
            slowest_um / way_per_ms <= stop_band::delay(&PositionParameters::NOMINAL).0,
            "{slowest_um} um"
        );
    }

    #[test]
    fn a_lowering_dial_that_is_opened_during_a_move_is_obeyed() {
        let parameters = PositionParameters::NOMINAL;
        let mut position = PositionControl::default();
        position.start();
        let mut limit_approach = |speed, dial| {
            let demand = Demand {
                direction: Direction::Lower,
                speed,
                acceleration: parameters.lower_acceleration,
            };
            position.limit_approach(demand, dial, &parameters).speed
        };
        let (fast, end) = (
            parameters.lower_speed,
            creep_multiple(FINAL_APPROACH_FACTOR, &parameters),
        );
        for dial in [MicrometrePerSecond::ZERO, parameters.creep_speed, end, fast] {
            assert_eq!(limit_approach(dial, dial), dial);
        }
        assert_eq!(limit_approach(end, fast), end, "its end");
        assert_eq!(limit_approach(fast, fast), end);
    }

    #[test]
    fn extreme_arguments_stay_finite() {
        for remaining in [i32::MIN, -1, 0, 1, i32::MAX] {
            for gain in [1, 200] {
                let speed = approach_speed(
                    Micrometre(remaining),
                    MillimetrePerSecondSquared(20_000),
                    PerSecond(gain),
                );
                assert!(speed >= MicrometrePerSecond::ZERO);
            }
        }
    }
}
