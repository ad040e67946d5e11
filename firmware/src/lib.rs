//! The firmware of an electro-hydraulic three-point hitch.
//!
//! [`control`] is the controller itself: pure, without clock, heap, I/O or floating point, and so
//! bit-identical on the ECU and on the host. Everything else in this crate carries it.
//!
//! Beside it, and as pure: [`can`] frames and their text form, [`j1939`] (the hitch on the tractor's
//! bus), [`xcp`] (measuring and calibrating), and [`storage`] of the calibration in flash. They are fed
//! with frames and time, hand out frames, and do a bounded amount of work a call.
//!
//! [`ecu`] ties all of it together into the application that runs on the ECU.
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

pub mod can;
pub mod control;
pub mod crc32;
pub mod ecu;
mod fnv;
pub mod j1939;
pub mod storage;
pub mod xcp;
