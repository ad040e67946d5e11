//! Stored states, as both versions keep them.

use std::panic::{AssertUnwindSafe, catch_unwind};

use super::guard::call;
use super::instance::{Fault, Instance, Stored};
use super::types::{Handle, StateHandle, Status};

/// Stores the state of an instance; `state` points to null, or to a stored state that is replaced.
///
/// # Safety
/// `instance` is null or an instance; `state` is null, or points to null or to a stored state.
pub unsafe fn store(instance: Handle, function: &str, state: *mut StateHandle) -> Status {
    let store = |instance: &mut Instance| {
        // SAFETY: by the contract above, it is null or a place for a state.
        let place = unsafe { state.as_mut() };
        let place = place.ok_or_else(|| Fault::error("the place for the state is null"))?;
        let stored = instance.store();
        // SAFETY: by the contract above, the place holds null or a state that was stored here.
        match unsafe { place.cast::<Stored>().as_mut() } {
            Some(before) => *before = stored,
            None => *place = Box::into_raw(Box::new(stored)).cast(),
        }
        Ok(())
    };
    // SAFETY: by the contract above, it is null or an instance.
    unsafe { call(instance, function, store) }
}

/// Goes back to a stored state.
///
/// # Safety
/// `instance` is null or an instance; `state` is null, or a state that was stored of it and is not freed.
pub unsafe fn restore(instance: Handle, function: &str, state: StateHandle) -> Status {
    let restore = |instance: &mut Instance| {
        // SAFETY: by the contract above, it is null or a state that was stored here.
        let stored = unsafe { state.cast::<Stored>().as_ref() };
        let stored =
            stored.ok_or_else(|| Fault::error("there is no stored state; store one first"))?;
        instance.restore(stored);
        Ok(())
    };
    // SAFETY: by the contract above, it is null or an instance.
    unsafe { call(instance, function, restore) }
}

/// Frees a stored state.
///
/// # Safety
/// `instance` is null or an instance; `state` is null, or points to null or to a stored state.
pub unsafe fn free(instance: Handle, function: &str, state: *mut StateHandle) -> Status {
    let free = |_: &mut Instance| {
        // SAFETY: by the contract above, it is null or a place that holds null or a stored state.
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
    // SAFETY: by the contract above, it is null or an instance.
    unsafe { call(instance, function, free) }
}
