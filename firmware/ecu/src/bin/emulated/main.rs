//! The firmware on an emulated Cortex-M4 (QEMU `mps2-an386`).
//!
//! Told `ecu` by the emulator (`-semihosting-config arg=ecu`), it is the ECU: the application in lock step with whoever
//! is at the emulator's standard input and output. Told `parts`, it measures what the parts of a step take. Otherwise
//! it steps the controller alone. At the end of the input it says on the console what it did and how much stack that
//! took, and ends the emulator with a status.

#![no_std]
#![no_main]

mod application;
mod command_line;
mod console;
mod flash_file;
mod host_file;
mod link;
mod outcome;
mod parts;
mod stack;
mod steps;
mod stopwatch;
mod word;

use core::hint::spin_loop;
use core::panic::PanicInfo;

use cortex_m_rt::{ExceptionFrame, entry, exception};
use cortex_m_semihosting::debug::{self, EXIT_FAILURE, EXIT_SUCCESS};

use console::print;
use link::Link;
use outcome::{Done, Failure};
use stopwatch::Stopwatch;
use word::Word;

#[entry]
fn main() -> ! {
    match run() {
        Ok(done) => {
            print(&[
                Word::Text("steps="),
                Word::Number(done.ticks),
                Word::Text("\nlongest_ticks="),
                Word::Number(done.longest),
                Word::Text("\nlongest_working_ticks="),
                Word::Number(done.longest_working),
                Word::Text("\nlongest_storing_ticks="),
                Word::Number(done.longest_storing),
                Word::Text("\nlongest_control_ticks="),
                Word::Number(done.longest_control),
                Word::Text("\nstack_bytes="),
                Word::Number(stack::high_water_mark()),
                Word::Text("\n"),
            ]);
            debug::exit(EXIT_SUCCESS);
        }
        Err(Failure::HostFile(error)) => fail(&error.words()),
        Err(Failure::Calibration) => fail(&[Word::Text("the nominal calibration is refused\n")]),
    }
    halt()
}

fn run() -> Result<Done, Failure> {
    let stopwatch = Stopwatch::start();
    if command_line::is(b"parts") {
        return parts::run(&stopwatch).map(|()| Done::default());
    }
    let mut link = Link::open()?;
    if command_line::is(b"ecu") {
        application::run(&mut link, &stopwatch)
    } else {
        steps::run(&mut link, &stopwatch)
    }
}

fn fail(words: &[Word<'_>]) {
    print(words);
    debug::exit(EXIT_FAILURE);
}

fn halt() -> ! {
    loop {
        spin_loop();
    }
}

#[panic_handler]
fn on_panic(info: &PanicInfo<'_>) -> ! {
    let (file, line) = info
        .location()
        .map_or(("?", 0), |place| (place.file(), place.line()));
    fail(&[
        Word::Text("panicked at "),
        Word::Text(file),
        Word::Text(":"),
        Word::Number(line),
        Word::Text(": "),
        Word::Text(info.message().as_str().unwrap_or("no fixed text")),
        Word::Text("\n"),
    ]);
    halt()
}

#[exception]
unsafe fn HardFault(frame: &ExceptionFrame) -> ! {
    fail(&[
        Word::Text("hard fault at address "),
        Word::Number(frame.pc()),
        Word::Text(", called from "),
        Word::Number(frame.lr()),
        Word::Text("\n"),
    ]);
    halt()
}
