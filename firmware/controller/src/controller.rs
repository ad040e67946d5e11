//! A step in two parts: control requests currents; protection limits them and sets the pulse widths of the coils.

use hitch_control::Control;
use hitch_control::commissioning::teach::{Taught, TeachError};
use hitch_control::current::Regulation;
use hitch_control::operator::EngineWatch;
use hitch_quantities::calibration::design_parameters::{
    BusParameters, PositionParameters, RateParameters,
};
use hitch_quantities::{Calibration, Inputs, Outputs, ValidCalibration};
use hitch_safety::{Command, Envelope, Limits, MachineModel};

use crate::memory_check::MemoryCheck;

#[cfg(test)]
mod damage;

/// The controller: control, the envelope that judges it, and the regulation of what the envelope lets pass.
#[derive(Clone, Debug)]
pub struct Controller {
    envelope: Envelope,
    memory: MemoryCheck,
    /// The last command of control.
    command: Command,
    regulation: Regulation,
    // The largest comes last, so that the others are close to the controller's address.
    control: Control,
}

impl Controller {
    /// A controller as it is after power-up: locked.
    #[must_use]
    pub fn new(calibration: ValidCalibration) -> Self {
        Self::with(calibration, EngineWatch::default())
    }

    /// The same, with the received engine speed. Not inlined: inlining would keep a copy of the controller on the
    /// stack of the caller.
    #[inline(never)]
    fn with(calibration: ValidCalibration, engine: EngineWatch) -> Self {
        Self {
            envelope: Envelope::default(),
            memory: MemoryCheck::default(),
            command: Command::default(),
            regulation: Regulation::new(&calibration.current),
            control: Control::new(calibration, engine),
        }
    }

    /// Takes a calibration at any time. If ramps or gains differ, they change under a moving hitch. If anything else
    /// differs, it is another machine, which the operator has to pick up anew.
    pub fn apply(&mut self, calibration: ValidCalibration) {
        let present = self.calibration();
        let same_machine = Calibration {
            position: PositionParameters {
                lower_limit: present.position.lower_limit,
                upper_limit: present.position.upper_limit,
                ..calibration.position
            },
            rate: RateParameters {
                rate_limit: present.rate.rate_limit,
                longest_travel: present.rate.longest_travel,
                ..calibration.rate
            },
            bus: BusParameters {
                measured_period: calibration.bus.measured_period,
                ..present.bus
            },
            checksum: calibration.checksum,
            ..(**present).clone()
        };
        if same_machine == *calibration {
            self.recalibrate(calibration)
        } else {
            self.restart(calibration)
        }
    }

    /// Takes a calibration that makes it another machine: everything begins anew, but an engine that has told its speed
    /// still has to, and a final trip stays.
    pub fn restart(&mut self, calibration: ValidCalibration) {
        let mut envelope = self.envelope;
        envelope.restart();
        *self = Self::with(calibration, self.control.engine());
        self.envelope = envelope;
    }

    /// The calibration in use.
    #[must_use]
    pub fn calibration(&self) -> &ValidCalibration {
        self.control.calibration()
    }

    /// Takes another calibration of the same machine: one whose ramps or gains differ. The hitch may be moving, and goes
    /// on from where it is.
    pub fn recalibrate(&mut self, calibration: ValidCalibration) {
        self.control.recalibrate(calibration);
        self.memory.begin_anew();
    }

    /// What teaching found, if the machine has been taught since power-up.
    #[must_use]
    pub const fn taught(&self) -> Option<Result<Taught, TeachError>> {
        self.control.taught()
    }

    /// One step of 1 ms: both parts.
    pub fn step(&mut self, inputs: &Inputs) -> Outputs {
        self.control(inputs);
        self.protect(inputs)
    }

    /// The first part of a step: computes the command. Nothing reaches the coils before [`Self::protect`].
    pub fn control(&mut self, inputs: &Inputs) {
        let request = self.control.step(inputs, self.envelope.holds_back());
        if request.recovered {
            self.envelope.disarm();
        }
        if request.healthy {
            self.envelope.reset();
        }
        if request.rides {
            self.envelope.claim_ride();
        }
        self.command = Command {
            currents: request.currents,
            step: self.envelope.step(),
        };
    }

    /// The second part: the envelope limits the command, the regulation makes pulse widths of it, and the envelope
    /// releases them. It has to run in each step. A command that control hasn't renewed since the last one is stale.
    pub fn protect(&mut self, inputs: &Inputs) -> Outputs {
        let calibration = self.control.calibration();
        let limits = Limits {
            safety: &calibration.safety,
            sensors: &calibration.sensors,
            lock: &calibration.lock,
            operator: &calibration.operator,
            rate: &calibration.rate,
            remote: &calibration.remote,
            ride: &calibration.ride,
            damaged: self.memory.step(calibration),
            machine: MachineModel::of(calibration),
        };
        let currents = self.envelope.pass(self.command, inputs, limits);
        if let Some(trip) = self.envelope.objection() {
            self.control.fail(trip.fault());
        }
        if self.envelope.has_ground_contact() {
            self.control.accept_ground_contact();
        }
        self.control.set_regulated_currents(currents);
        let parameters = &self.control.calibration().current;
        let duties = self.regulation.drive(currents, inputs, parameters);
        let duties = self.envelope.release(duties);
        Outputs {
            lift_current: currents.lift,
            lower_current: currents.lower,
            lift_duty: duties.lift,
            lower_duty: duties.lower,
            trip: self.envelope.tripped(),
            ..self.control.outputs()
        }
    }
}
