//! What moves teach about this machine, kept from one to the next and forgotten with the supply.
//!
//! ```text
//! how far a hitch trails its valve   lag       lag of its spool        during the move, kept at rest
//! how far a move goes                course    offset of its valve     half a second later, or before a correction
//! ```
//!
//! The first is in [`crate::estimation::motion`], for it needs the estimate of every step.

use hitch_quantities::units::Micrometre;

use super::offset::Offsets;
use crate::estimation::course::{Course, Told};
use crate::estimation::motion::Motion;
use crate::valve::phase::{Direction, Phase};

/// A lift that comes to rest further beyond its set point than this has swung there: 0.6 degree.
const OVERSHOT: Micrometre = Micrometre(1_000);

/// The move under way, and what the ones before taught.
#[derive(Clone, Copy, Debug, Default)]
pub struct Learning {
    course: Option<Course>,
    offsets: Offsets,
}

impl Learning {
    /// How far the valves are off their curves.
    #[must_use]
    pub const fn offsets(&self) -> &Offsets {
        &self.offsets
    }

    /// A move to a set point begins at `from`, where the hitch rested.
    pub fn begin(&mut self, direction: Direction, from: Micrometre) {
        self.course = Some(Course::begin(direction, from));
    }

    /// Something has a part in this move: it tells nothing.
    pub fn obstruct(&mut self) {
        self.course = None;
    }

    /// A move that came to rest `beyond` its set point is to be corrected: it is over now, and tells more than others
    /// do. A lift that swung that far shows the swing alone. True until the move has been evaluated.
    pub fn hurries(&mut self, beyond: Micrometre, motion: &mut Motion) -> bool {
        if let Some(course) = &mut self.course {
            course.end();
            if course.direction() == Direction::Lift && beyond > OVERSHOT {
                motion.overshot();
                self.course = None;
            }
        }
        self.course.is_some()
    }

    /// The valves' curves are others now.
    pub fn forget_curves(&mut self) {
        self.course = None;
        self.offsets = Offsets::default();
    }

    /// One step of the way from rest to rest; the move once it is over.
    pub fn follow(&mut self, phase: Phase, motion: &Motion) -> Option<Course> {
        match self.course.as_mut()?.step(phase, motion) {
            true => self.course.take(),
            false => None,
        }
    }

    /// Takes in how far a move went.
    pub fn learn(&mut self, told: &Told) {
        self.offsets.learn(told);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_move_to_be_corrected_is_told_first_and_a_lift_that_swung_tells_nothing() {
        for (direction, beyond, swings) in [
            (Direction::Lift, OVERSHOT, false),
            (Direction::Lift, OVERSHOT + Micrometre(1), true),
            (Direction::Lower, OVERSHOT + Micrometre(1), false),
        ] {
            let (mut learning, mut motion) = (Learning::default(), Motion::default());
            assert!(!learning.hurries(beyond, &mut motion), "nothing under way");
            learning.begin(direction, Micrometre::ZERO);
            assert_eq!(learning.hurries(beyond, &mut motion), !swings);
            assert_eq!(motion.swings(), swings);
            let told = learning.follow(Phase::Holding, &motion);
            assert_eq!(told.is_some(), !swings, "{direction:?}");
            assert!(!learning.hurries(beyond, &mut motion));
        }
    }
}
