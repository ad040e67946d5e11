//! Types of FMI 2.0 alone.

use std::ffi::{c_int, c_void};

use crate::abi::logger::FormatFunction;
use crate::abi::types::Status;

/// A truth value; 0 is false.
pub type Fmi2Boolean = c_int;

/// False.
pub const FMI2_FALSE: Fmi2Boolean = 0;
/// `fmi2Type` of an instance for co-simulation.
pub const CO_SIMULATION: c_int = 1;

/// Functions of the importer.
#[repr(C)]
pub struct Callbacks {
    /// Writes a message.
    pub logger: Option<FormatFunction>,
    /// Allocates memory; not used here.
    pub allocate_memory: Option<unsafe extern "C" fn(usize, usize) -> *mut c_void>,
    /// Frees memory; not used here.
    pub free_memory: Option<unsafe extern "C" fn(*mut c_void)>,
    /// Told at the end of an asynchronous step; not used here.
    pub step_finished: Option<unsafe extern "C" fn(*mut c_void, Status)>,
    /// Given back to the importer with each message.
    pub environment: *mut c_void,
}
