//! Communication and storage of the hitch: bus, calibration tools and flash. All code is pure: it gets frames, time and
//! flash, returns frames, and does a bounded amount of work in each call.
//!
//! It may depend on `hitch-quantities` only: its interface to the controller are inputs, outputs and the calibration.
//!
//! Folders from the bottom to the top; each may use those above it in this list (checked by `cargo xtask check`):
//!
//! * [`can`]: frames and their text form,
//! * [`j1939`]: the hitch on the tractor's bus,
//! * [`key`]: challenge and response for safety values,
//! * [`storage`]: the calibration and the trouble codes in flash,
//! * [`xcp`]: measurement and calibration.
//!
//! ```
//! use hitch_protocols::j1939::hitch::{position, raw_position};
//! use hitch_quantities::units::PerMille;
//!
//! // A position on the bus is in steps of 0.4 %.
//! assert_eq!(position(raw_position(Some(PerMille(500)))), PerMille(500));
//! ```
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

pub mod can;
pub mod j1939;
pub mod key;
pub mod storage;
pub mod xcp;
