//! Types of FMI 3.0 alone.

use std::ffi::c_void;

/// A truth value; 0 is false. It has the size of C's `bool`, and an importer's other values are no fault here.
pub type Fmi3Boolean = u8;

/// False.
pub const FMI3_FALSE: Fmi3Boolean = 0;

/// A function of the importer that is never called here.
pub type Unused = Option<unsafe extern "C" fn()>;

/// Pointer of the importer, which is passed back with each message.
pub type Environment = *mut c_void;
