//! What moves teach about this machine, kept from one to the next and forgotten with the supply.
//!
//! ```text
//! how far a hitch trails its valve   lag       lag of its spool        during the move, kept at rest
//! how far a move goes                course    offset of its valve     half a second later, or before a correction
//! ```
//!
//! The first is in [`super::motion`], for it needs the estimate of every step.

use super::course::{Course, Told};
use super::motion::Motion;
use super::offset::Offsets;
use super::units::Micrometre;
use super::valve_logic::{Direction, Phase};

/// A lift that comes to rest further beyond its set point than this has swung there: 0.6 degree.
const OVERSHOT: Micrometre = Micrometre(1_000);

/// The move under way, and what the ones before taught.
#[derive(Clone, Copy, Debug, Default)]
pub struct Learning {
    course: Option<Course>,
    /// What a move told that is over and how much of it is its valve's threshold's, until its lag is taken in.
    over: Option<(Told, Micrometre)>,
    /// What it told until its offset is.
    told: Option<Told>,
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
        self.over = None;
        self.course = None;
    }

    /// A move that came to rest `beyond` its set point is to be corrected: it is over now, and tells more than others
    /// do. A lift that swung that far tells of nothing else. True until all has been taken in.
    pub fn hurries(&mut self, beyond: Micrometre, motion: &mut Motion) -> bool {
        if let Some(course) = &mut self.course {
            course.end();
            if course.direction() == Direction::Lift && beyond > OVERSHOT {
                motion.overshot();
                self.course = None;
            }
        }
        self.course.is_some() || self.over.is_some() || self.told.is_some()
    }

    /// The valves' curves are others now.
    pub fn forget_curves(&mut self) {
        self.course = None;
        self.over = None;
        self.told = None;
        self.offsets = Offsets::default();
    }

    /// One step of the way from rest to rest; the move once it is over. What takes long waits for a step with `room`.
    pub fn follow(&mut self, phase: Phase, motion: &Motion, room: bool) -> Option<Course> {
        if room && let Some(told) = self.told.take() {
            self.offsets.learn(&told);
        }
        match self.course.as_mut()?.step(phase, motion) && room {
            true => self.course.take(),
            false => None,
        }
    }

    /// A move is over: its lag is learnt in the next step, its offset in the one after that. All in one would take too
    /// long.
    pub fn end(&mut self, told: Told) {
        self.over = Some((told, self.offsets.blamed(&told)));
    }

    /// What a move told that has just been over, to learn its lag from, and how much of it is its threshold's.
    pub fn over(&mut self) -> Option<(Told, Micrometre)> {
        self.over.take()
    }

    /// Takes in how far a move went, in the next step.
    pub fn learn(&mut self, told: Told) {
        self.told = Some(told);
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
            let told = learning.follow(Phase::Holding, &motion, true);
            assert_eq!(told.is_some(), !swings, "{direction:?}");
            assert!(!learning.hurries(beyond, &mut motion));
        }
    }
}
