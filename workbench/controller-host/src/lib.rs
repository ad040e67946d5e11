//! The firmware's controller on a computer: [calibration files](calibration_file), [samples] in engineering
//! units, and [teaching].
//!
//! The program `hitch` and the FMU use it, so that both drive the controller in the same way.
#![forbid(unsafe_code)]

pub mod calibration_file;
pub mod samples;
pub mod teaching;
