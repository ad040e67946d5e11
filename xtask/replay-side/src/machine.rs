//! A controller and, beside it, an envelope of its own that gets commands from outside.

use hitch_controller::Controller;
use hitch_quantities::calibration::calibration_words::SCALARS_WORD;
use hitch_quantities::units::{Duty, MilliAmp};
use hitch_quantities::{Calibration, CoilCurrents, Duties, Inputs, ValidCalibration};
use hitch_safety::{Command, Envelope, Step};

use crate::interface::{INPUTS, calibrate, inputs, limits, outputs};
use crate::{ANSWER_WORDS, STEP_WORDS};

/// Words of a step in front of its inputs: event, index and value of a parameter, commanded currents of the lift and the
/// lowering coil, flags.
pub const HEAD_WORDS: usize = 6;

/// What happens before a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(i32)]
pub enum Event {
    /// Nothing.
    None = 0,
    /// Power-up, with the nominal calibration.
    PowerUp = 1,
    /// A parameter gets a value, if the calibration is then valid.
    Calibrate = 2,
}

/// Bits of the flags: the command is stale; the envelope is asked to reset; it is disarmed; its calibration is damaged.
const STALE: i32 = 1;
const RESET: i32 = 2;
const DISARM: i32 = 4;
const DAMAGED: i32 = 8;

/// What the machine answers besides the outputs of its controller.
pub const ENVELOPE_OUTPUTS: [&str; 9] = [
    "calibration.accepted",
    "envelope.lift_current",
    "envelope.lower_current",
    "envelope.lift_duty",
    "envelope.lower_duty",
    "envelope.trip",
    "envelope.objection",
    "envelope.ground_contact",
    "envelope.holds_back",
];

/// A machine.
struct Machine {
    calibration: ValidCalibration,
    controller: Controller,
    envelope: Envelope,
}

impl Machine {
    fn new() -> Self {
        let calibration = ValidCalibration::nominal();
        Self {
            controller: Controller::new(calibration.clone()),
            envelope: Envelope::default(),
            calibration,
        }
    }

    /// True if the value is accepted.
    fn calibrate(&mut self, parameter: usize, value: i32) -> bool {
        let mut words = self.calibration.to_words();
        let Some(word) = words.get_mut(SCALARS_WORD + parameter) else {
            return false;
        };
        *word = value;
        let Ok(calibration) = Calibration::from_words(&words).seal() else {
            return false;
        };
        self.calibration = calibration.clone();
        calibrate(&mut self.controller, calibration);
        true
    }

    fn pass(&mut self, currents: CoilCurrents, flags: i32, inputs: &Inputs) -> [i32; 8] {
        if flags & DISARM != 0 {
            self.envelope.disarm();
        }
        if flags & RESET != 0 {
            self.envelope.reset();
        }
        let step = match flags & STALE {
            0 => self.envelope.step(),
            _ => Step::default(),
        };
        let limits = limits(&self.calibration, flags & DAMAGED != 0);
        let passed = self
            .envelope
            .pass(Command { currents, step }, inputs, limits);
        let released = self.envelope.release(Duties {
            lift: Duty(currents.lift.0),
            lower: Duty(currents.lower.0),
        });
        [
            passed.lift.0,
            passed.lower.0,
            released.lift.0,
            released.lower.0,
            self.envelope.tripped().map_or(0, |trip| trip as i32),
            self.envelope.objection().map_or(0, |trip| trip as i32),
            i32::from(self.envelope.has_ground_contact()),
            i32::from(self.envelope.holds_back()),
        ]
    }

    fn step(&mut self, step: &[i32; STEP_WORDS], answer: &mut Vec<i32>) {
        let [event, parameter, value, lift, lower, flags, words @ ..] = step;
        let words: &[i32; INPUTS.len()] = words;
        let mut accepted = false;
        if *event == Event::PowerUp as i32 {
            *self = Self::new();
        } else if *event == Event::Calibrate as i32 {
            accepted = self.calibrate(
                usize::try_from(*parameter).unwrap_or(usize::MAX / 2),
                *value,
            );
        }
        let inputs = inputs(words);
        answer.extend(outputs(&self.controller.step(&inputs)));
        answer.push(i32::from(accepted));
        let currents = CoilCurrents {
            lift: MilliAmp(*lift),
            lower: MilliAmp(*lower),
        };
        answer.extend(self.pass(currents, *flags, &inputs));
    }
}

/// Independent machines.
#[derive(Default)]
pub struct Machines {
    machines: Vec<Machine>,
}

impl Machines {
    /// A step of each machine, from the first on; `answers` is replaced by theirs. A machine that was not there before is
    /// powered up.
    pub fn round(&mut self, steps: &[i32], answers: &mut Vec<i32>) {
        answers.clear();
        let (steps, _) = steps.as_chunks::<STEP_WORDS>();
        answers.reserve(steps.len() * ANSWER_WORDS);
        while self.machines.len() < steps.len() {
            self.machines.push(Machine::new());
        }
        for (machine, step) in self.machines.iter_mut().zip(steps) {
            machine.step(step, answers);
        }
    }
}
