//! Types of the standard.

use std::ffi::{c_char, c_int, c_void};

/// A unit's instance, as an importer holds it.
pub type Handle = *mut c_void;
/// A stored state, as an importer holds it.
pub type StateHandle = *mut c_void;
/// Index of a variable.
pub type ValueReference = u32;
/// A text that ends with a zero byte.
pub type Text = *const c_char;

/// What a function returns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(C)]
pub enum Status {
    /// All is well.
    Ok = 0,
    /// All is well, with a message.
    Warning = 1,
    /// Not done; the importer may go on.
    Discard = 2,
    /// The instance cannot be simulated further without a reset.
    Error = 3,
    /// No instance can be used any more.
    Fatal = 4,
    /// Not yet done, never returned here.
    Pending = 5,
}

/// A truth value; 0 is false.
pub type Boolean = c_int;

/// False.
pub const FALSE: Boolean = 0;
/// `fmi2Type` of an instance for co-simulation.
pub const CO_SIMULATION: c_int = 1;

/// Writes a message: environment, instance, status, category, format as of `printf`, and its arguments.
pub type FormatFunction = unsafe extern "C" fn(*mut c_void, Text, Status, Text, Text, ...);

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
