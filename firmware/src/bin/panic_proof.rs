//! Proves at link time that the controller can't panic.
//!
//! The panic handler calls a function that nobody defines. As long as the compiler, with overflow checks on, can show
//! that no step of any controller on any inputs gets there, the handler is thrown away and this image links; otherwise
//! the linker names `the_controller_can_panic`. The image is never run.

#![no_std]
#![no_main]

use core::hint::black_box;
use core::panic::PanicInfo;

use cortex_m_rt::entry;
use hitch_firmware::control::signals::INPUT_BYTES;
use hitch_firmware::control::{Calibration, Controller, Inputs};

unsafe extern "C" {
    safe fn the_controller_can_panic() -> !;
}

#[entry]
fn main() -> ! {
    // The compiler must not know what the calibration holds: any that validation lets through has to be safe.
    let calibration = black_box(Calibration::nominal());
    if let Ok(calibration) = calibration.validate() {
        let mut controller = Controller::new(calibration);
        loop {
            let record = black_box([0; INPUT_BYTES]);
            black_box(controller.step(&Inputs::from_bytes(&record)).to_bytes());
        }
    }
    loop {
        black_box(());
    }
}

#[panic_handler]
fn on_panic(_: &PanicInfo<'_>) -> ! {
    the_controller_can_panic()
}
