//! A step in two parts: control asks for currents, protection decides what the coils get.

use hitch_control::operator::mode::Mode;
use hitch_quantities::units::MicroLitrePerSecond;
use hitch_quantities::{CoilCurrents, Fault, Inputs, Outputs};
use hitch_safety::{Command, Limits, Machine};

use crate::controller::Controller;

impl Controller {
    /// One step of 1 ms: both parts.
    pub fn step(&mut self, inputs: &Inputs) -> Outputs {
        self.control(inputs);
        self.protect(inputs)
    }

    /// The first part of a step: computes the command. Nothing reaches the coils before [`Self::protect`].
    pub fn control(&mut self, inputs: &Inputs) {
        let sensed = self.sensors.judge(inputs, &self.calibration.sensors);
        let currents = match sensed.and_then(|sensed| self.run(&sensed, inputs)) {
            Ok(currents) => currents,
            Err(fault) => self.fail(fault),
        };
        self.angle = sensed.map(|sensed| sensed.angle).unwrap_or_default();
        self.command = Command {
            currents,
            step: self.envelope.step(),
        };
    }

    /// The second part: the envelope limits the command, the regulation makes pulse widths of it, and the envelope
    /// releases them. It has to run in each step. A command that control hasn't renewed since the last one is stale.
    pub fn protect(&mut self, inputs: &Inputs) -> Outputs {
        let limits = Limits {
            safety: &self.calibration.safety,
            sensors: &self.calibration.sensors,
            damaged: self.memory.step(&self.calibration),
            machine: Machine::of(&self.calibration),
            slow_start: matches!(self.mode, Mode::Teach),
        };
        let currents = self.envelope.pass(self.command, inputs, limits);
        if let Some(trip) = self.envelope.objection() {
            self.fail(trip.fault());
        }
        if self.envelope.has_landed() {
            self.stop_where_it_is();
            self.position.accept();
        }
        // A button's speed falls with the linkage and stays: what the map gets wrong there does as well.
        let slowing = self.slack.is_taken() && matches!(self.mode, Mode::Position);
        self.motion.drive(
            self.learning.offsets().on_curve(currents),
            slowing,
            self.scale,
            &self.calibration,
        );
        let duties = self
            .regulation
            .drive(currents, inputs, &self.calibration.current);
        let duties = self.envelope.release(duties);
        self.outputs(currents, duties, self.angle)
    }

    /// A fault: both coils off at once.
    fn fail(&mut self, fault: Fault) -> CoilCurrents {
        if matches!(self.mode, Mode::Teach) {
            self.teach.abort();
        }
        self.mode = Mode::failed(fault);
        self.button.distrust();
        self.demanded_flow = MicroLitrePerSecond::ZERO;
        self.phase = self.phase.cut();
        CoilCurrents::OFF
    }
}
