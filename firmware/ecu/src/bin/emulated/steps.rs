//! The controller alone, step by step.
//!
//! A record of [`Inputs`] in; the [`Outputs`] and the timer ticks that the step took (u32, little endian) out.

use core::hint::black_box;

use hitch_controller::Controller;
use hitch_quantities::signals::INPUT_BYTES;
use hitch_quantities::{Calibration, Inputs, Outputs};

use crate::link::Link;
use crate::outcome::{Done, Failure};
use crate::stopwatch::Stopwatch;

/// Steps until the input ends.
#[inline(never)]
pub fn run(link: &mut Link, stopwatch: &Stopwatch) -> Result<Done, Failure> {
    let calibration = Calibration::nominal().validate()?;
    let mut controller = Controller::new(calibration);
    let mut done = Done::default();
    while let Some(record) = link.read::<INPUT_BYTES>()? {
        let given = Inputs::from_bytes(&record);
        let (taken, ticks) =
            stopwatch.ticks_of(|| step(black_box(&mut controller), black_box(&given)));
        link.write(&taken.to_bytes())?;
        link.write(&ticks.to_le_bytes())?;
        done.ticks += 1;
        done.longest = done.longest.max(ticks);
    }
    Ok(done)
}

/// The step as the ECU's control task calls it: not merged into the loop around it.
#[inline(never)]
fn step(controller: &mut Controller, inputs: &Inputs) -> Outputs {
    controller.step(inputs)
}
