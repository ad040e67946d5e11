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
mod tests;
