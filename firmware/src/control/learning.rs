//! What moves teach about this machine, kept from one to the next and forgotten with the supply.
//!
//! ```text
//! how a lift sets in       trail     lag of both spools      during the move
//! where a move ends        run_on    lag of its spool        at rest
//! how far a move goes      course    offset of its valve     half a second later
//! ```
//!
//! The first is in [`super::motion`], for it needs the estimate of every step.

use super::course::{Course, Told};
use super::motion::Motion;
use super::offset::Offsets;
use super::run_on::RunOn;
use super::units::{Micrometre, MicrometrePerSecond, Microsecond};
use super::valve_logic::{Direction, Phase};

/// A lag that turned out to be longer by so much.
type Further = (Direction, Microsecond);

/// The move under way, and what the ones before taught.
#[derive(Clone, Copy, Debug, Default)]
pub struct Learning {
    course: Option<Course>,
    offsets: Offsets,
    run_on: Option<(Direction, RunOn)>,
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
        self.run_on = Some((direction, RunOn::default()));
    }

    /// The set point moved on the way: where this move ends tells nothing.
    pub fn divert(&mut self) {
        self.run_on = None;
    }

    /// Something has a part in this move: it tells nothing.
    pub fn obstruct(&mut self) {
        self.course = None;
        self.run_on = None;
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

    /// One step towards the end of a move, which is over once it holds; `ahead`: how far the set point is.
    pub fn approach(
        &mut self,
        next: Phase,
        creep: MicrometrePerSecond,
        slowing: bool,
        ahead: Micrometre,
    ) -> Option<Further> {
        let (direction, run_on) = self.run_on.as_mut()?;
        let direction = *direction;
        match next {
            Phase::Moving { speed, .. } => run_on.step(speed, creep, slowing),
            Phase::Settling { .. } => {}
            Phase::Holding => {
                let beyond = Micrometre(direction.sign((-ahead).0));
                let further = run_on.lag_error(beyond);
                self.run_on = None;
                return Some((direction, further));
            }
        }
        None
    }
}
