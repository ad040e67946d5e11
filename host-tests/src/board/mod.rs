//! A bench for the images as they are flashed: the ELF files run on an emulated processor with models of the parts'
//! peripherals, and the plant on its pins.
//!
//! ```text
//!   ELF -> Cpu (Unicorn) <-> Chip: clocks, flash, pins, timers, converters, CAN, watchdog
//!                              |  volts, levels, frames        pulse widths, enable line, frames
//!                              v                                 ^
//!                            Board, an `EcuMachine` <-> Bench: plant, coils, sensors, operator
//! ```
//!
//! The models go by the reference manuals (RM0090, RM0440) and data sheets. What the image must not do is recorded as
//! a violation, and [`Chip::audit`] judges what it has set up. Time is counted in instructions, two clocks each.

mod adc;
mod audit;
mod block_counts;
mod can;
mod chip;
mod clocks;
mod conditions;
mod counters;
mod cpu;
mod flash;
mod image;
mod machine;
mod part;
mod pwm;
mod registers;
pub mod scenarios;
mod watchdog;

pub use chip::{Chip, Stop};
pub use conditions::Conditions;
pub use flash::{Contents, Extent, Operation};
pub use image::Image;
pub use machine::{Board, ENABLE_READ_BACK, Snapshot};
pub use part::{Part, Pin, Port};
