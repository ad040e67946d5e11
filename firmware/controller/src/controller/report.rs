//! What a controller says of itself.

use hitch_control::operator::mode::Mode;
use hitch_control::valve::phase::{Direction, Phase};
use hitch_quantities::units::MilliDegree;
use hitch_quantities::{CoilCurrents, Duties, Outputs, State};

use crate::controller::Controller;

impl Controller {
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
            _ if self.saturation.rests() => State::Stalled,
            (_, Phase::Settling { .. }) => State::Settling,
            (_, Phase::Holding) => State::Holding,
        }
    }

    /// The outputs of a step that ends with these currents and duties.
    pub(super) fn outputs(
        &self,
        currents: CoilCurrents,
        duties: Duties,
        angle: MilliDegree,
    ) -> Outputs {
        Outputs {
            lift_current: currents.lift,
            lower_current: currents.lower,
            state: self.state(),
            fault: self.mode.fault(),
            trip: self.envelope.tripped(),
            target: self.position.set_point(angle),
            travel: self.motion.position(),
            demanded_speed: self.phase.speed(),
            demanded_flow: self.demanded_flow,
            speed: self.motion.speed(),
            drop: self.load.drop(),
            lift_duty: duties.lift,
            lower_duty: duties.lower,
        }
    }
}
