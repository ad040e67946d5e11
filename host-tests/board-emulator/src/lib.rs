//! A bench for the flashed images: the ELF files run on an emulated processor with models of the peripherals, and with
//! the plant at the pins.
//!
//! ```text
//!   ELF -> Cpu (Unicorn) <-> Chip: clocks, flash, pins, timers, converters, CAN, watchdog
//!                              |  volts, levels, frames        pulse widths, enable line, frames
//!                              v                                 ^
//!                            Board, an `EcuMachine` <-> Bench: plant, coils, sensors, operator
//! ```
//!
//! The models follow the reference manuals (RM0090, RM0440) and data sheets. Forbidden operations of the image are
//! recorded as violations, and `audit::findings` checks its initialisation. Time is counted in instructions of two cycles
//! each.

mod adc;
mod audit;
mod block_counts;
mod can;
mod chip;
mod clocks;
mod conditions;
mod counters;
mod cpu;
pub mod ecu_tool;
mod enable_line;
mod flash;
mod image;
mod layout;
mod machine;
mod part;
mod pwm;
mod registers;
mod regular;
pub mod scenarios;
mod watchdog;

pub use chip::{Chip, Stop};
pub use conditions::Conditions;
pub use enable_line::ENABLE_READ_BACK;
pub use flash::{Contents, Extent, Operation};
pub use image::Image;
pub use layout::Layout;
pub use machine::{Board, Snapshot};
pub use part::{Part, Pin, Port};
