//! What the rest of the firmware computes with: quantities, the calibration of a machine, and what goes into a step and
//! comes out of it. All of it is pure, without clock, heap, I/O or floating point.
//!
//! It may depend on no other crate of the firmware. Control, the safety envelope and the protocols meet in these types
//! and know nothing of each other.
//!
//! From the bottom to the top:
//!
//! * [`units`] and [`fixed`]: integers with their unit in the type, and the few operations that they are built from;
//!   [`crc32`] and [`fnv`] for checksums and keys; [`piston`] between flow and speed; [`codes!`] for enumerations with
//!   codes; [`image`] for fixed images of numbers,
//! * [`calibration`]: what a machine can be taught, as the ECU stores it,
//! * [`signals`]: inputs and outputs of a step, currents of the coils, and the codes of faults and trips.
//!
//! ```
//! use hitch_quantities::calibration::linkage::LinkageTable;
//! use hitch_quantities::units::MilliDegree;
//! use hitch_quantities::{Calibration, CalibrationError};
//!
//! let mut block = Calibration::nominal();
//! let linkage: &LinkageTable = &block.linkage;
//! assert!(linkage.travel(MilliDegree(90_000)) > linkage.travel(MilliDegree(80_000)));
//! // One that has been changed has to be sealed, or it is refused.
//! block.position.upper_limit = MilliDegree(100_000);
//! assert!(matches!(block.clone().validate(), Err(CalibrationError::Checksum { .. })));
//! assert!(block.sealed().validate().is_ok());
//! ```
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

pub mod calibration;
mod codes;
pub mod crc32;
pub mod fixed;
pub mod fnv;
pub mod image;
pub mod piston;
pub mod signals;
pub mod units;

pub use calibration::{Calibration, CalibrationError, ValidCalibration};
pub use signals::coils::{CoilCurrents, Duties};
pub use signals::fault::Fault;
pub use signals::field::{Function, Reason, Trouble};
pub use signals::trip::Trip;
pub use signals::{Inputs, Outputs, State, Switches};
