//! Stored states, and what needs derivatives.

use std::ffi::c_char;

use crate::abi::guard::call;
use crate::abi::instance::{Fault, Instance};
use crate::abi::stored;
use crate::abi::types::{Handle, StateHandle, Status, ValueReference};

/// Message for a function that no unit supports.
fn unsupported(flag: &str) -> Fault {
    Fault::error(format!(
        "is not supported: {flag} is false in modelDescription.xml"
    ))
}

/// Stores the state of an instance; `state` points to null, or to a stored state that is replaced.
///
/// # Safety
/// As the standard says: `component` is an instance, and `state` points to null or to a stored state.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetFMUstate(component: Handle, state: *mut StateHandle) -> Status {
    // SAFETY: the importer gives null or an instance, and null or a place for a state.
    unsafe { stored::store(component, "fmi2GetFMUstate", state) }
}

/// Goes back to a stored state.
///
/// # Safety
/// As the standard says: `component` is an instance, and `state` a state that was stored of it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetFMUstate(component: Handle, state: StateHandle) -> Status {
    // SAFETY: the importer gives null or an instance, and null or a state that was stored of it.
    unsafe { stored::restore(component, "fmi2SetFMUstate", state) }
}

/// Frees a stored state.
///
/// # Safety
/// As the standard says: `component` is an instance, and `state` points to null or to a stored state.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2FreeFMUstate(component: Handle, state: *mut StateHandle) -> Status {
    // SAFETY: the importer gives null or an instance, and null or a place that holds null or a stored state.
    unsafe { stored::free(component, "fmi2FreeFMUstate", state) }
}

/// States have no image in bytes.
///
/// # Safety
/// As the standard says: `component` is an instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SerializedFMUstateSize(
    component: Handle,
    _state: StateHandle,
    _size: *mut usize,
) -> Status {
    let refuse = |_: &mut Instance| Err(unsupported("canSerializeFMUstate"));
    // SAFETY: the importer gives null or an instance, and calls one function at a time.
    unsafe { call(component, "fmi2SerializedFMUstateSize", refuse) }
}

/// States have no image in bytes.
///
/// # Safety
/// As the standard says: `component` is an instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SerializeFMUstate(
    component: Handle,
    _state: StateHandle,
    _bytes: *mut c_char,
    _size: usize,
) -> Status {
    let refuse = |_: &mut Instance| Err(unsupported("canSerializeFMUstate"));
    // SAFETY: the importer gives null or an instance, and calls one function at a time.
    unsafe { call(component, "fmi2SerializeFMUstate", refuse) }
}

/// States have no image in bytes.
///
/// # Safety
/// As the standard says: `component` is an instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2DeSerializeFMUstate(
    component: Handle,
    _bytes: *const c_char,
    _size: usize,
    _state: *mut StateHandle,
) -> Status {
    let refuse = |_: &mut Instance| Err(unsupported("canSerializeFMUstate"));
    // SAFETY: the importer gives null or an instance, and calls one function at a time.
    unsafe { call(component, "fmi2DeSerializeFMUstate", refuse) }
}

/// Directional derivatives are not known.
///
/// # Safety
/// As the standard says: `component` is an instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetDirectionalDerivative(
    component: Handle,
    _unknowns: *const ValueReference,
    _unknown_count: usize,
    _knowns: *const ValueReference,
    _known_count: usize,
    _seed: *const f64,
    _sensitivity: *mut f64,
) -> Status {
    let refuse = |_: &mut Instance| Err(unsupported("providesDirectionalDerivative"));
    // SAFETY: the importer gives null or an instance, and calls one function at a time.
    unsafe { call(component, "fmi2GetDirectionalDerivative", refuse) }
}
