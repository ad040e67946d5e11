//! Stored states, and what needs derivatives.

use std::ffi::c_char;
use std::panic::{AssertUnwindSafe, catch_unwind};

use super::guard::call;
use super::instance::{Fault, Instance, Stored};
use super::types::{Handle, StateHandle, Status, ValueReference};

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
    let store = |instance: &mut Instance| {
        // SAFETY: the importer gives null or a place for a state.
        let place = unsafe { state.as_mut() };
        let place = place.ok_or_else(|| Fault::error("the place for the state is null"))?;
        let stored = instance.store();
        // SAFETY: the place holds null or a state that was stored here.
        match unsafe { place.cast::<Stored>().as_mut() } {
            Some(before) => *before = stored,
            None => *place = Box::into_raw(Box::new(stored)).cast(),
        }
        Ok(())
    };
    // SAFETY: the importer gives null or an instance, and calls one function at a time.
    unsafe { call(component, "fmi2GetFMUstate", store) }
}

/// Goes back to a stored state.
///
/// # Safety
/// As the standard says: `component` is an instance, and `state` a state that was stored of it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetFMUstate(component: Handle, state: StateHandle) -> Status {
    let restore = |instance: &mut Instance| {
        // SAFETY: the importer gives null or a state that was stored here.
        let stored = unsafe { state.cast::<Stored>().as_ref() };
        let stored =
            stored.ok_or_else(|| Fault::error("there is no stored state; store one first"))?;
        instance.restore(stored);
        Ok(())
    };
    // SAFETY: the importer gives null or an instance, and calls one function at a time.
    unsafe { call(component, "fmi2SetFMUstate", restore) }
}

/// Frees a stored state.
///
/// # Safety
/// As the standard says: `component` is an instance, and `state` points to null or to a stored state.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2FreeFMUstate(component: Handle, state: *mut StateHandle) -> Status {
    let free = |_: &mut Instance| {
        // SAFETY: the importer gives null or a place that holds null or a stored state.
        let place = unsafe { state.as_mut() };
        let held = place.map_or(std::ptr::null_mut(), |place| {
            std::mem::replace(place, std::ptr::null_mut())
        });
        if !held.is_null() {
            // SAFETY: it is not null, so it was made by `store` from a box, and the place no longer has it.
            let stored = unsafe { Box::from_raw(held.cast::<Stored>()) };
            let _ = catch_unwind(AssertUnwindSafe(|| drop(stored)));
        }
        Ok(())
    };
    // SAFETY: the importer gives null or an instance, and calls one function at a time.
    unsafe { call(component, "fmi2FreeFMUstate", free) }
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
