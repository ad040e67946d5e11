//! What moves teach about this machine, kept from one to the next and forgotten with the supply.
//!
//! ```text
//! how far a hitch trails its valve   lag       lag of its spool        during the move, kept at rest
//! how far a move goes                course    offset of its valve     half a second later
//! ```
//!
//! The first is in [`super::motion`], for it needs the estimate of every step.

use super::course::{Course, Told};
use super::motion::Motion;
use super::offset::Offsets;
use super::units::Micrometre;
use super::valve_logic::{Direction, Phase};

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

    /// Something has a part in this move: it tells nothing. Which way it went, if it isn't long over.
    pub fn obstruct(&mut self) -> Option<Direction> {
        self.over = None;
        self.course.take().map(|course| course.direction())
    }

    /// The valves' curves are others now.
    pub fn forget_curves(&mut self) {
        self.course = None;
        self.over = None;
        self.told = None;
        self.offsets = Offsets::default();
    }

    /// One step of the way from rest to rest; the move once it is over.
    pub fn follow(&mut self, phase: Phase, motion: &Motion) -> Option<Course> {
        if let Some(told) = self.told.take() {
            self.offsets.learn(&told);
        }
        match self.course.as_mut()?.step(phase, motion) {
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
