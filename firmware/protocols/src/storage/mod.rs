//! What is kept in flash: two copies of the calibration, of which the newer good one counts, and a log of faults.
//!
//! [`store`] writes the copy that doesn't count, so whatever power does in the middle of it, the other one stays as
//! it was; a copy counts once its last byte is right. [`record`] is what its two blocks look like, the safety values and
//! all others, each with its own sequence number and checksum: every value stands there under a key, so firmware with
//! another layout finds what it knows and takes its own defaults for the rest. [`fault_log`] has flash of its own, so
//! nothing that it does touches a calibration; [`fault_history`] decides what is written there, and when.

mod copy_state;
pub mod fault_history;
pub mod fault_log;
mod layout;
mod reader;
pub mod record;
pub mod store;

pub use layout::{COPY_BYTES, Copy};
pub use store::{CalibrationStore, Loaded, Progress, SafetySource, Source, StoreError};
