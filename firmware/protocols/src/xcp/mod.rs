//! Measuring and calibrating over CAN: an XCP slave (ASAM MCD-1 XCP 1.x), as free and commercial tools speak it.
//!
//! [`Slave`] answers commands and samples measurements; it knows addresses only. What is behind an address is a
//! [`Memory`]'s business, and the ECU's is a map without pointers ([`map`]): a slot of four bytes for each word
//! of the calibration ([`pages`]), and one for each measurement ([`measurements`]). So a description file (A2L)
//! depends on the tables of this crate and not on where a linker put what, and nothing else can be read or
//! written at all.

pub mod angle_noise;
mod checksum;
mod command;
mod daq;
mod error;
pub mod map;
pub mod measurements;
mod measuring;
mod memory;
mod packet;
pub mod pages;
mod paging;
mod slave;

pub use error::Refusal;
pub use map::{Access, EcuMemory};
pub use measurements::Measurements;
pub use memory::{Memory, MemoryRange, Page, Text};
pub use pages::CalibrationPages;
pub use slave::{Event, Slave, TOOL_ADDRESS};
