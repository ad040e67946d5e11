//! ECU bench: the firmware's application, emulated or on the host, with plant, operator and bus.

mod bench;
mod bus;
mod converters;
mod emulator;
mod flash;
mod image;
mod machine;
mod operator;
mod pace;
mod runner;
pub mod slcan_server;

pub use bench::{Bench, Moment};
pub use bus::Bus;
pub use converters::{Signals, ratiometric_codes};
pub use emulator::{Emulator, Mode, QEMU, command as emulator_command};
pub use flash::{CALIBRATION_BYTES, CutFlash, FLASH_BYTES, delivered};
pub use image::{IMAGE_VARIABLE, find as find_image};
pub use machine::{EcuMachine, MachineError, OnHost};
pub use operator::{Operator, Order, PICK_UP_MS, reach_deg};
pub use pace::{Pace, PaceChange};
pub use runner::{PoweredEcu, Runner};
