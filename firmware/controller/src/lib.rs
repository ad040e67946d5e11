//! The controller: from lever and sensors to two coil currents, one [`Controller::step`] a millisecond.
//!
//! ```text
//! Inputs -> control -> safety envelope -> current regulation -> safety envelope -> Outputs
//! ```
//!
//! It may depend on `hitch-control`, `hitch-safety` and `hitch-quantities`, and is where the two that know nothing of each
//! other meet.
//!
//! * [`controller`]: the step,
//! * [`memory_check`]: whether the calibration in use is still what was validated.
//!
//! ```
//! use hitch_controller::Controller;
//! use hitch_quantities::units::{MilliAmp, MilliDegree};
//! use hitch_quantities::{Inputs, State, ValidCalibration};
//!
//! let mut controller = Controller::new(ValidCalibration::nominal());
//! let inputs = Inputs {
//!     lever: Some(MilliDegree(100_000)),
//!     rocker_angle: Some(MilliDegree(90_000)),
//!     ..Inputs::default()
//! };
//! // Nothing moves until the lever has been moved through the hitch.
//! let outputs = controller.step(&inputs);
//! assert_eq!(outputs.state, State::Locked);
//! assert_eq!(outputs.lift_current, MilliAmp::ZERO);
//! ```
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

pub mod controller;
pub mod memory_check;

pub use controller::Controller;
