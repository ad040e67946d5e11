//! Detects a load that oscillates on its pressure compensator. Such a load needs gentle ramps.
//!
//! A compensator that follows the load pressure with a lag `T` reduces the drop `d` over the lift valve by `T p'`. With
//! stiff oil, the pressure accelerates the load `M`: `M v'' = A p'`. The velocity then no longer equals the steady
//! velocity `v_0` of the valve opening:
//!
//! ```text
//! v = v_0 sqrt(1 - T p' / d)     so     v'' = K (1 - (v / v_0)^2),     K = A d / (M T)
//! ```
//!
//! This is a nearly undamped oscillation about `v_0` with the angular frequency `sqrt(2 K / v_0)`: 2.7 Hz behind the
//! open valve for 230 kg and 10 ms, higher for smaller openings. An edge of 40 ms makes the hitch half as fast again as
//! the valve. If the valve closes then, only gravity stops the load. Slow opening and closing does not excite the
//! oscillation.
//!
//! Detection uses the start of the lift. The compensator first has to rise from the idle pressure of the pump, then the
//! velocity grows with the square of the time. The lag behind the lift valve ([`super::spool_lag`]) exceeds that of the
//! lowering valve, which has no compensator, by 14 ms or more. This is known early enough to brake the same move
//! gently.
//!
//! Two other causes give the same lag. A shifted valve curve is recognised by the distance of a short lift, or else by
//! the small lag of the gentle moves that follow. A lift spool that is slower than the lowering spool is recognised by
//! the peak velocity ratio ([`super::peak_velocity_ratio`]). An oscillation without a large lag is recognised by its
//! overshoot. A move with an oscillation is not used to identify lags and offsets.
//!
//! A calibration may have the lag (`hydraulics.compensator_lag`); the oscillation is then confirmed from the first move
//! on.
//!
//! ```text
//! NotDetected --- large lag ---> Suspected --- next move ---> Detected
//!    ^  ^  \__ large overshoot __> Confirmed                     |
//!    |  +---- distance error of a short lift ---+                |
//!    +------------------- lag of a spool ------------------------+
//!
//! Suspected --- small peak velocity ratio --> RuledOut --- large overshoot --> Confirmed
//! ```

use hitch_quantities::units::{MicrometrePerSecond, Millisecond};

use super::delayed_output::Pole;
use super::millisecond_q3::MillisecondQ3;
use crate::valve::phase::{Direction, Phase};

/// State of the detection.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CompensatorOscillation {
    /// No evidence yet.
    #[default]
    NotDetected,
    /// A large lag in the present move, which began with steep ramps.
    Suspected,
    /// A large lag in an earlier move.
    Detected,
    /// A lift overshot its set point by far.
    Confirmed,
    /// The lag was that of a slow spool.
    RuledOut,
}

/// Largest lag difference of the two spools of a machine, with the effect of threshold offsets. A smaller one is no
/// oscillation.
const MAX_SPOOL_LAG_DIFFERENCE: MillisecondQ3 = MillisecondQ3(8 * 12);

impl CompensatorOscillation {
    /// Takes the lag of the present lift, in excess of the lowering lag. A lag above `limit` is too large for a spool.
    pub fn suspect(&mut self, lag: MillisecondQ3, limit: MillisecondQ3) {
        if *self == Self::NotDetected && lag > limit {
            *self = Self::Suspected;
        }
    }

    /// A move begins. `lag`: that of the compensator by the calibration. A known lag needs no evidence.
    pub fn begin_move(&mut self, lag: Millisecond) {
        if lag > Millisecond::ZERO {
            *self = Self::Confirmed;
        } else if *self == Self::Suspected {
            *self = Self::Detected;
        }
    }

    /// Takes the peak velocity ratio of a finished lift. If the load has not `oscillated`, the lift spool is slow, and
    /// the lag of later lifts is no evidence.
    pub fn rule_out(&mut self, oscillated: bool) {
        if *self == Self::Suspected && !oscillated {
            *self = Self::RuledOut;
        }
    }

    /// Evaluates a finished lift. `lag`: lag in excess of the lowering lag; `residual_lag`: what remains of it after
    /// the correction by the distance error. True if the move may be used to identify lag and offset.
    ///
    /// A shifted threshold gives a short lift an apparent lag of up to 1.5 times the `limit`; the distance error
    /// explains nearly all of it. An oscillating load makes up for its lag after the valve has closed, so a large
    /// residual confirms the oscillation. Gentle lifts do not revoke that: they hardly show a compensator lag of 3 or 4
    /// ms.
    pub fn evaluate_move(
        &mut self,
        lag: MillisecondQ3,
        residual_lag: MillisecondQ3,
        limit: MillisecondQ3,
    ) -> bool {
        let max_threshold_lag = limit + MillisecondQ3(limit.0 / 2);
        match *self {
            Self::Suspected if residual_lag > MillisecondQ3(limit.0 / 2) => *self = Self::Confirmed,
            Self::Suspected
                if lag < max_threshold_lag && residual_lag < MillisecondQ3(limit.0 / 4) =>
            {
                *self = Self::NotDetected;
                return true;
            }
            Self::Suspected => {}
            _ => return true,
        }
        false
    }

    /// Takes the lag of a gentle lift, in excess of the lowering lag. A small lag revokes the detection.
    pub fn revoke(&mut self, lag: MillisecondQ3) {
        if *self == Self::Detected && lag < MAX_SPOOL_LAG_DIFFERENCE {
            *self = Self::NotDetected;
        }
    }

    /// A lift overshot its set point by far.
    pub fn confirm(&mut self) {
        *self = Self::Confirmed;
    }

    /// The present move was obstructed or cancelled: its lag is no evidence.
    pub fn discard_move(&mut self) {
        if *self == Self::Suspected {
            *self = Self::NotDetected;
        }
    }

    /// True if gentle ramps are needed.
    #[must_use]
    pub fn is_detected(self) -> bool {
        !matches!(self, Self::NotDetected | Self::RuledOut)
    }

    /// Poles of the observer behind a sensor with lag; those for an oscillation while such a load is lifted.
    #[must_use]
    pub fn pole(self, phase: Phase) -> Pole {
        let lifts = matches!(
            phase,
            Phase::Moving {
                direction: Direction::Lift,
                ..
            }
        );
        if lifts && self.is_detected() {
            Pole::OSCILLATING
        } else {
            Pole::USUAL
        }
    }

    /// Time constant of the bias estimate while lifting at `speed`; `usual` without an oscillation.
    ///
    /// A bias estimate that is as fast as the oscillation amplifies it. The oscillation is slow behind an open valve
    /// and fast behind a nearly closed one, where a threshold error has to be corrected: one millisecond for each mm/s.
    #[must_use]
    pub fn bias_time(self, usual: Millisecond, speed: MicrometrePerSecond) -> Millisecond {
        /// Largest increase: with 80 ms the bias settles in a sixth of a second.
        const MAX_INCREASE: i32 = 50;
        match self {
            Self::NotDetected | Self::RuledOut => usual,
            _ => Millisecond(
                usual
                    .0
                    .saturating_add((speed.0 >> 10).clamp(0, MAX_INCREASE)),
            ),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMIT: MillisecondQ3 = MillisecondQ3(8 * 16);

    #[test]
    fn the_move_that_shows_an_oscillation_is_not_used_and_the_next_ones_are() {
        let mut oscillation = CompensatorOscillation::default();
        oscillation.suspect(LIMIT, LIMIT);
        assert_eq!(
            oscillation,
            CompensatorOscillation::NotDetected,
            "a slow spool is no oscillation"
        );
        oscillation.suspect(MillisecondQ3(LIMIT.0 + 1), LIMIT);
        assert!(oscillation.is_detected());
        assert!(
            !oscillation.evaluate_move(LIMIT, MillisecondQ3(LIMIT.0 / 3), LIMIT),
            "swung"
        );
        oscillation.begin_move(Millisecond::ZERO);
        oscillation.suspect(MillisecondQ3(0), LIMIT);
        assert_eq!(oscillation, CompensatorOscillation::Detected);
        assert!(oscillation.evaluate_move(LIMIT, LIMIT, LIMIT), "was gentle");
        oscillation.discard_move();
        assert!(oscillation.is_detected(), "known from an earlier move");
    }

    #[test]
    fn a_gentle_move_revokes_a_detection_but_no_confirmation() {
        for (mut oscillation, after) in [
            (
                CompensatorOscillation::Detected,
                CompensatorOscillation::NotDetected,
            ),
            (
                CompensatorOscillation::Confirmed,
                CompensatorOscillation::Confirmed,
            ),
        ] {
            oscillation.revoke(MAX_SPOOL_LAG_DIFFERENCE);
            assert!(oscillation.is_detected(), "trails too far for a spool");
            oscillation.revoke(MillisecondQ3(MAX_SPOOL_LAG_DIFFERENCE.0 - 1));
            assert_eq!(oscillation, after);
        }
        let mut oscillation = CompensatorOscillation::Suspected;
        oscillation.confirm();
        oscillation.discard_move();
        assert_eq!(oscillation, CompensatorOscillation::Confirmed);
    }

    #[test]
    fn a_shifted_threshold_is_ruled_out_and_an_oscillation_is_not() {
        let suspected = || {
            let mut oscillation = CompensatorOscillation::default();
            oscillation.suspect(MillisecondQ3(LIMIT.0 + 1), LIMIT);
            oscillation
        };
        for (lag_ms, residual_ms, after) in [
            (20, -3, CompensatorOscillation::NotDetected),
            (20, 6, CompensatorOscillation::Suspected),
            (20, 10, CompensatorOscillation::Confirmed),
            (40, -3, CompensatorOscillation::Suspected),
        ] {
            let mut oscillation = suspected();
            let tells = oscillation.evaluate_move(
                MillisecondQ3(8 * lag_ms),
                MillisecondQ3(8 * residual_ms),
                LIMIT,
            );
            assert_eq!(tells, after == CompensatorOscillation::NotDetected);
            assert_eq!(oscillation, after, "{lag_ms} ms, {residual_ms} ms residual");
        }
        for extreme in [i32::MIN, i32::MAX].map(MillisecondQ3) {
            let mut known = suspected();
            known.begin_move(Millisecond::ZERO);
            assert!(known.evaluate_move(extreme, extreme, extreme));
            assert_eq!(
                known,
                CompensatorOscillation::Detected,
                "told by an earlier lift"
            );
        }
    }

    #[test]
    fn a_small_peak_velocity_ratio_rules_an_oscillation_out_for_later_lifts() {
        let noticed = || {
            let mut oscillation = CompensatorOscillation::default();
            oscillation.suspect(MillisecondQ3(LIMIT.0 + 1), LIMIT);
            oscillation
        };
        let mut oscillation = noticed();
        oscillation.rule_out(true);
        assert_eq!(oscillation, CompensatorOscillation::Suspected, "oscillated");
        oscillation.rule_out(false);
        assert!(
            oscillation.evaluate_move(LIMIT, LIMIT, LIMIT),
            "tells of its spool"
        );
        oscillation.begin_move(Millisecond::ZERO);
        oscillation.suspect(MillisecondQ3(i32::MAX), LIMIT);
        assert!(!oscillation.is_detected());
        oscillation.confirm();
        oscillation.rule_out(false);
        assert_eq!(
            oscillation,
            CompensatorOscillation::Confirmed,
            "overshot all the same"
        );
        let mut known = noticed();
        known.begin_move(Millisecond::ZERO);
        known.rule_out(false);
        assert_eq!(known, CompensatorOscillation::Detected, "was gentle");
    }

    #[test]
    fn a_lag_that_the_calibration_has_needs_no_evidence() {
        let mut known = CompensatorOscillation::default();
        known.begin_move(Millisecond(1));
        assert!(known.is_detected(), "in the first lift");
        let moving = |direction| Phase::Moving {
            direction,
            speed: MicrometrePerSecond::ZERO,
        };
        assert_eq!(known.pole(moving(Direction::Lift)), Pole::OSCILLATING);
        assert_eq!(known.pole(moving(Direction::Lower)), Pole::USUAL);
        assert_eq!(known.pole(Phase::Holding), Pole::USUAL);
        known.revoke(MillisecondQ3(0));
        known.rule_out(false);
        known.discard_move();
        assert!(known.is_detected());
    }

    #[test]
    fn an_obstacle_is_no_oscillation() {
        let mut oscillation = CompensatorOscillation::default();
        oscillation.suspect(MillisecondQ3(i32::MAX), LIMIT);
        oscillation.discard_move();
        assert_eq!(oscillation, CompensatorOscillation::NotDetected);
    }

    #[test]
    fn only_an_oscillating_load_slows_the_bias_estimate() {
        let usual = Millisecond(30);
        let time = |oscillation: CompensatorOscillation, speed: i32| {
            oscillation.bias_time(usual, MicrometrePerSecond(speed)).0
        };
        for speed in [i32::MIN, 0, 100_000, i32::MAX] {
            assert_eq!(time(CompensatorOscillation::NotDetected, speed), 30);
        }
        assert_eq!(
            [i32::MIN, 0, 10_240, 100_000, i32::MAX]
                .map(|speed| time(CompensatorOscillation::Detected, speed)),
            [30, 30, 40, 80, 80]
        );
    }
}
