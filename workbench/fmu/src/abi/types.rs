//! Types that both versions of the standard have.

use std::ffi::{c_char, c_void};

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
    /// Not yet done, FMI 2.0 only; never returned here.
    Pending = 5,
}
