//! The controller on an emulated Cortex-M4 (QEMU `mps2-an386`).
//!
//! Reads records of inputs from the host's file or pipe `inputs`, steps the controller once a record and writes to
//! `outputs`, for each step, the outputs and the timer ticks that the step took (u32, little endian). At the end it
//! says on the console how many steps it ran and how much stack it used, and ends the emulator with a status.
//! `inputs` is opened first: a host that uses pipes must open them in the same order.

#![no_std]
#![no_main]

mod host_file;
mod stack;
mod stopwatch;

use core::fmt::{Arguments, Write};
use core::hint::{black_box, spin_loop};
use core::panic::PanicInfo;

use cortex_m_rt::{ExceptionFrame, entry, exception};
use cortex_m_semihosting::debug::{self, EXIT_FAILURE, EXIT_SUCCESS};

use hitch_firmware::control::signals::INPUT_BYTES;
use hitch_firmware::control::{Calibration, CalibrationError, Controller, Inputs, Outputs};
use host_file::{HostFile, HostFileError};
use stopwatch::Stopwatch;

/// Why the image ends early.
enum Failure {
    HostFile(HostFileError),
    Calibration(CalibrationError),
}

impl From<HostFileError> for Failure {
    fn from(error: HostFileError) -> Self {
        Self::HostFile(error)
    }
}

#[entry]
fn main() -> ! {
    match run() {
        Ok(steps) => {
            say(format_args!(
                "steps={steps}\nstack_bytes={}\n",
                stack::high_water_mark()
            ));
            debug::exit(EXIT_SUCCESS);
        }
        Err(Failure::HostFile(error)) => fail(format_args!("{error}\n")),
        Err(Failure::Calibration(error)) => fail(format_args!(
            "the nominal calibration is refused: {error:?}\n"
        )),
    }
    halt()
}

/// Steps the controller until `inputs` ends; the number of steps.
fn run() -> Result<u32, Failure> {
    let calibration = Calibration::nominal()
        .validate()
        .map_err(Failure::Calibration)?;
    let mut controller = Controller::new(calibration);
    let mut inputs = HostFile::open_for_reading(c"inputs")?;
    let mut outputs = HostFile::open_for_writing(c"outputs")?;
    let stopwatch = Stopwatch::start();
    let mut record = [0; INPUT_BYTES];
    let mut steps = 0;
    while inputs.read_record(&mut record)? {
        let given = Inputs::from_bytes(&record);
        let (taken, ticks) =
            stopwatch.ticks_of(|| step(black_box(&mut controller), black_box(&given)));
        outputs.write_all(&taken.to_bytes())?;
        outputs.write_all(&ticks.to_le_bytes())?;
        steps += 1;
    }
    Ok(steps)
}

/// The step as the ECU's control task calls it: not merged into the loop around it.
#[inline(never)]
fn step(controller: &mut Controller, inputs: &Inputs) -> Outputs {
    controller.step(inputs)
}

fn say(text: Arguments<'_>) {
    if let Ok(mut console) = HostFile::console() {
        // Nobody is left to tell if the console itself fails.
        let _ = console.write_fmt(text);
    }
}

fn fail(text: Arguments<'_>) {
    say(text);
    debug::exit(EXIT_FAILURE);
}

fn halt() -> ! {
    loop {
        spin_loop();
    }
}

#[panic_handler]
fn on_panic(info: &PanicInfo<'_>) -> ! {
    fail(format_args!("{info}\n"));
    halt()
}

#[exception]
unsafe fn HardFault(frame: &ExceptionFrame) -> ! {
    fail(format_args!("hard fault: {frame:?}\n"));
    halt()
}
