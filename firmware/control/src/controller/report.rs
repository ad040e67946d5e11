//! Outputs of control.

use hitch_quantities::{Outputs, State};

use super::Control;
use crate::operator::mode::Mode;
use crate::valve::phase::{Direction, Phase};

impl Control {
    fn state(&self) -> State {
        match (&self.mode, self.phase) {
            (Mode::Fault { .. }, _) => State::Fault,
            (Mode::Locked(_), _) => State::Locked,
            (Mode::TransportLock, _) => State::TransportLock,
            (Mode::Teach, _) => State::Teaching,
            (
                _,
                Phase::Moving {
                    direction: Direction::Lift,
                    ..
                },
            ) => State::Lifting,
            (
                _,
                Phase::Moving {
                    direction: Direction::Lower,
                    ..
                },
            ) => State::Lowering,
            _ if self.float.is_floating() => State::Floating,
            _ if self.stall.is_waiting() => State::Stalled,
            (_, Phase::Settling { .. }) => State::Settling,
            (_, Phase::Holding) => State::Holding,
        }
    }

    /// Outputs of a step, without currents, pulse widths and trip, which the caller adds.
    #[must_use]
    pub fn outputs(&self) -> Outputs {
        Outputs {
            state: self.state(),
            fault: self.mode.fault(),
            target: self.position.set_point(self.angle),
            travel: self.motion.position(),
            demanded_speed: self.phase.speed(),
            demanded_flow: self.demanded_flow,
            speed: self.motion.speed(),
            drop: self.load.drop(),
            reference: self.reference.reason(),
            trouble: self.reference.trouble(),
            draft: self.reference.draft(),
            ..Outputs::default()
        }
    }
}
