//! Stored states.

use crate::abi::stored;
use crate::abi::types::{Handle, StateHandle, Status};

/// Stores the state of an instance; `state` points to null, or to a stored state that is replaced.
///
/// # Safety
/// As the standard says: `instance` is an instance, and `state` points to null or to a stored state.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetFMUState(instance: Handle, state: *mut StateHandle) -> Status {
    // SAFETY: the importer gives null or an instance, and null or a place for a state.
    unsafe { stored::store(instance, "fmi3GetFMUState", state) }
}

/// Goes back to a stored state.
///
/// # Safety
/// As the standard says: `instance` is an instance, and `state` a state that was stored of it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetFMUState(instance: Handle, state: StateHandle) -> Status {
    // SAFETY: the importer gives null or an instance, and null or a state that was stored of it.
    unsafe { stored::restore(instance, "fmi3SetFMUState", state) }
}

/// Frees a stored state.
///
/// # Safety
/// As the standard says: `instance` is an instance, and `state` points to null or to a stored state.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3FreeFMUState(instance: Handle, state: *mut StateHandle) -> Status {
    // SAFETY: the importer gives null or an instance, and null or a place that holds null or a stored state.
    unsafe { stored::free(instance, "fmi3FreeFMUState", state) }
}
