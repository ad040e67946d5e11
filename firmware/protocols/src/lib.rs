//! What the hitch speaks, and what it keeps: bus, tuning and storage. Pure: fed with frames, time and flash, it hands out
//! frames, and does a bounded amount of work a call.
//!
//! It may depend on `hitch-quantities` alone: what it says of the controller is in inputs, outputs and the calibration.
//!
//! Its folders from the bottom to the top; one may use those above it in this list (`cargo xtask check` holds them to it):
//!
//! * [`can`]: frames and their text form,
//! * [`j1939`]: the hitch on the tractor's bus,
//! * [`storage`]: the calibration and the trouble codes in flash,
//! * [`xcp`]: measuring and calibrating.
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
pub mod storage;
pub mod xcp;
