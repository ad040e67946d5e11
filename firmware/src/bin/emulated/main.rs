//! The firmware on an emulated Cortex-M4 (QEMU `mps2-an386`).
//!
//! Told `ecu` by the emulator (`-semihosting-config arg=ecu`), it is the ECU: the application in lock step with whoever
//! is at the emulator's standard input and output. Told `parts`, it measures what the parts of a step take. Otherwise it
//! steps the controller alone. At the end of the input it says
//! on the console what it did and how much stack that took, and ends the emulator with a status.

#![no_std]
#![no_main]

mod application;
mod command_line;
mod flash_file;
mod host_file;
mod link;
mod parts;
mod stack;
mod steps;
mod stopwatch;

use core::fmt::{Arguments, Write};
use core::hint::spin_loop;
use core::panic::PanicInfo;

use cortex_m_rt::{ExceptionFrame, entry, exception};
use cortex_m_semihosting::debug::{self, EXIT_FAILURE, EXIT_SUCCESS};

use hitch_firmware::control::CalibrationError;
use host_file::{HostFile, HostFileError};
use link::Link;
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
        Ok(done) => {
            say(format_args!(
                "steps={}\nlongest_ticks={}\nlongest_working_ticks={}\nstack_bytes={}\n",
                done.ticks,
                done.longest,
                done.longest_working,
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

fn run() -> Result<Done, Failure> {
    let stopwatch = Stopwatch::start();
    if command_line::is(b"parts") {
        return parts::run(&stopwatch).map(|()| Done::default());
    }
    let mut link = Link::open()?;
    match command_line::is(b"ecu") {
        true => application::run(&mut link, &stopwatch),
        false => steps::run(&mut link, &stopwatch),
    }
}

/// What was done.
#[derive(Default)]
struct Done {
    /// Steps or milliseconds.
    ticks: u32,
    /// The longest of them, in ticks of the stopwatch.
    longest: u32,
    /// The longest of those with a coil on, if that is told apart.
    longest_working: u32,
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
