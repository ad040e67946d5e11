//! Adaptation of the valve model to this machine. The result is kept between moves and lost with the supply.
//!
//! ```text
//! position error during a move     spool lag           adapted during the move, kept at rest
//! distance error of a move         threshold offset    adapted half a second later, or before a correction
//! ```
//!
//! The spool lag is part of [`crate::estimation::motion_observer`], because it needs the observer in every step.

use hitch_quantities::units::Micrometre;

use super::threshold_offset::ThresholdOffsets;
use crate::estimation::motion_observer::MotionObserver;
use crate::estimation::move_record::{MoveRecord, MoveRecorder};
use crate::valve::phase::Direction;

/// Recorder of the present move, and the offsets that earlier moves identified.
#[derive(Clone, Copy, Debug, Default)]
pub struct ValveAdaptation {
    recorder: Option<MoveRecorder>,
    offsets: ThresholdOffsets,
}

impl ValveAdaptation {
    /// Threshold offsets of the valves.
    #[must_use]
    pub const fn offsets(&self) -> &ThresholdOffsets {
        &self.offsets
    }

    /// A move to a set point begins at the rest position `from`.
    pub fn begin(&mut self, direction: Direction, from: Micrometre) {
        self.recorder = Some(MoveRecorder::begin(direction, from));
    }

    /// The move is disturbed: discards its record.
    pub fn discard_move(&mut self) {
        self.recorder = None;
    }

    /// A correction is due: finishes the record of the move that ended with this `overshoot`. A large overshoot of a
    /// lift, beyond `limit`, is caused by an oscillation, so it does not identify the offset. True until the move has been
    /// evaluated.
    pub fn finish_before_correction(
        &mut self,
        overshoot: Micrometre,
        limit: Micrometre,
        motion: &mut MotionObserver,
    ) -> bool {
        if let Some(recorder) = &mut self.recorder {
            recorder.finish();
            if recorder.direction() == Direction::Lift && overshoot > limit {
                motion.confirm_oscillation();
                self.recorder = None;
            }
        }
        self.recorder.is_some()
    }

    /// The valve curves have changed: resets the adaptation.
    pub fn reset_for_new_curves(&mut self) {
        self.recorder = None;
        self.offsets = ThresholdOffsets::default();
    }

    /// One step of a move; the recorder once the move is finished. `rests`: see [`MoveRecorder::step`].
    pub fn follow(&mut self, rests: bool, motion: &MotionObserver) -> Option<MoveRecorder> {
        if self
            .recorder
            .as_mut()?
            .step(rests, motion.model_speed(), motion.slope())
        {
            self.recorder.take()
        } else {
            None
        }
    }

    /// Takes in the record of a move. `noise`: see [`ThresholdOffsets::learn`].
    pub fn learn(&mut self, record: &MoveRecord, noise: Micrometre) {
        self.offsets.learn(record, noise);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMIT: Micrometre = Micrometre(1_000);

    #[test]
    fn a_move_is_evaluated_before_its_correction_and_an_oscillating_lift_is_discarded() {
        for (direction, overshoot, swings) in [
            (Direction::Lift, LIMIT, false),
            (Direction::Lift, LIMIT + Micrometre(1), true),
            (Direction::Lower, LIMIT + Micrometre(1), false),
        ] {
            let (mut adaptation, mut motion) =
                (ValveAdaptation::default(), MotionObserver::default());
            assert!(
                !adaptation.finish_before_correction(overshoot, LIMIT, &mut motion),
                "nothing under way"
            );
            adaptation.begin(direction, Micrometre::ZERO);
            assert_eq!(
                adaptation.finish_before_correction(overshoot, LIMIT, &mut motion),
                !swings
            );
            assert_eq!(motion.has_compensator_oscillation(), swings);
            let record = adaptation.follow(true, &motion);
            assert_eq!(record.is_some(), !swings, "{direction:?}");
            assert!(!adaptation.finish_before_correction(overshoot, LIMIT, &mut motion));
        }
    }
}
