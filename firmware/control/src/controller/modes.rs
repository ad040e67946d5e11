//! Mode transitions and faults.

use hitch_quantities::units::MicroLitrePerSecond;
use hitch_quantities::{CoilCurrents, Fault, Inputs};

use super::Control;
use crate::commissioning::teach::Teach;
use crate::motion::position::PositionControl;
use crate::motion::rate::RateControl;
use crate::operator::mode::Mode;

impl Control {
    /// A fault: both coils are switched off at once.
    pub fn fail(&mut self, fault: Fault) -> CoilCurrents {
        if matches!(self.mode, Mode::Teach) {
            self.teach.abort();
        }
        self.mode = Mode::failed(fault);
        self.ride.end();
        self.button.distrust();
        self.demanded_flow = MicroLitrePerSecond::ZERO;
        self.phase = self.phase.cut();
        CoilCurrents::OFF
    }

    /// Mode transitions that do not depend on the lever.
    pub(super) fn update_mode(&mut self, jog_requested: bool, inputs: &Inputs) {
        let was_teaching = matches!(self.mode, Mode::Teach);
        let engine = self
            .engine
            .permits(inputs.engine_speed, &self.calibration.lock);
        self.mode = self.mode.switched(inputs.switches, engine);
        if inputs.switches.transport_lock || !engine {
            self.button.distrust();
        }
        let was_fault = self.mode.fault().is_some();
        self.mode = self.mode.healthy(&self.calibration.lock);
        if was_fault && self.mode.fault().is_none() {
            self.recovered = true;
            self.stall.reset();
            self.drift.reset();
        }
        // After release of the button the hitch ramps down before it locks.
        let jogged = jog_requested || self.phase.is_moving();
        let in_jog = matches!(self.mode, Mode::Jog);
        self.mode = self.mode.jogged(
            if in_jog { jogged } else { jog_requested },
            inputs.switches.teach && !self.phase.is_moving(),
        );
        match (was_teaching, matches!(self.mode, Mode::Teach)) {
            (false, true) => self.teach = Teach::default(),
            (true, false) => self.teach.abort(),
            _ => {}
        }
        if jog_requested && !in_jog {
            self.rate = RateControl::default();
            self.position = PositionControl::default();
        }
        let follows_lever = matches!(self.mode, Mode::Position);
        self.quick_lift
            .press(inputs.switches.quick_lift, follows_lever);
        if !follows_lever {
            self.engage.end();
            self.float.end();
            self.reference.end();
            self.ride.end();
        }
    }
}
