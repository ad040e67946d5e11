//! Outputs of control.

use hitch_quantities::units::{MicrometrePerSecond, Millisecond};
use hitch_quantities::{Outputs, Reason, State};

use super::Control;
use crate::operator::mode::Mode;
use crate::valve::phase::{Direction, Phase};

impl Control {
    fn state(&self) -> State {
        let speed = self.demanded_speed();
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
            _ if speed > MicrometrePerSecond::ZERO => State::Lifting,
            _ if speed < MicrometrePerSecond::ZERO => State::Lowering,
            _ if self.float.is_floating() => State::Floating,
            _ if self.stall.is_waiting() => State::Stalled,
            (_, Phase::Settling { .. }) => State::Settling,
            (_, Phase::Holding) => State::Holding,
        }
    }

    /// Piston speed that the phase, or ride damping, asks of the valves.
    fn demanded_speed(&self) -> MicrometrePerSecond {
        self.ride.demand().unwrap_or(self.phase.speed())
    }

    /// Outputs of a step, without currents, pulse widths and trip, which the caller adds.
    #[must_use]
    pub fn outputs(&self) -> Outputs {
        Outputs {
            state: self.state(),
            fault: self.mode.fault(),
            target: self.position.set_point(self.angle),
            travel: self.motion.position(),
            demanded_speed: self.demanded_speed(),
            demanded_flow: self.demanded_flow,
            speed: self.motion.speed(),
            drop: self.load.drop(),
            reference: match self.ride.demand() {
                Some(_) => Some(Reason::Ride),
                None => self.reference.reason(),
            },
            trouble: self
                .reference
                .trouble()
                .or(self.ride.trouble(&self.calibration)),
            draft: self.reference.draft(),
            in_work: self.in_work.now(),
            time_until_work: match self.in_work.now() {
                Some(true) => Some(Millisecond::ZERO),
                Some(false) => self.until_work,
                None => None,
            },
            ..Outputs::default()
        }
    }
}
