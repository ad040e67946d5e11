//! Measurement and calibration over CAN: an XCP slave (ASAM MCD-1 XCP 1.x), compatible with free and commercial tools.
//!
//! [`Slave`] answers commands and samples measurements by address. [`EcuMemory`] maps the addresses, a
//! map without pointers ([`map`]): a slot of four bytes for each word of the calibration ([`pages`]), and one for each
//! measurement ([`measurements`]). A description file (A2L) therefore depends on the tables of this crate and not on
//! the linker, and no other memory is accessible.

pub mod angle_noise;
mod checksum;
mod command;
mod daq;
mod error;
mod event;
pub mod map;
pub mod measurements;
mod measuring;
mod memory;
mod packet;
pub mod pages;
mod paging;
mod slave;
mod unlocking;

pub use error::Refusal;
pub use event::Event;
pub use map::{Access, EcuMemory};
pub use measurements::Measurements;
pub use memory::Page;
pub use pages::{CalibrationPages, Right};
pub use slave::{Slave, TOOL_ADDRESS};
