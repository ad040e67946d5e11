//! What every call passes: a check of the instance, and a stop for panics.

use std::any::Any;
use std::ffi::CStr;
use std::panic::{AssertUnwindSafe, catch_unwind};

use super::instance::{Fault, Instance, Phase};
use super::types::{Handle, Status, Text};

/// Calls `act` on an instance. A fault is logged, and an error ends the simulation of the instance.
///
/// # Safety
/// `instance` is null, or an instance that this library has made and nobody has freed, which no other call uses.
pub unsafe fn call(
    instance: Handle,
    function: &str,
    act: impl FnOnce(&mut Instance) -> Result<(), Fault>,
) -> Status {
    // SAFETY: by the contract above, it is null or points to an instance that nobody else uses.
    let Some(instance) = (unsafe { instance.cast::<Instance>().as_mut() }) else {
        return Status::Error;
    };
    let result = catch_unwind(AssertUnwindSafe(|| act(instance))).unwrap_or_else(|panic| {
        instance.enter(Phase::Failed);
        Err(Fault::error(format!(
            "the simulation failed: {}; reset or free the instance",
            said(&*panic)
        )))
    });
    let Err(fault) = result else {
        return Status::Ok;
    };
    let log = || {
        let message = format!("{function}: {}", fault.message);
        instance.logger.write(fault.status, &message);
    };
    let _ = catch_unwind(AssertUnwindSafe(log));
    fault.status
}

/// Message of a panic.
pub fn said(panic: &(dyn Any + Send)) -> &str {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| panic.downcast_ref::<&str>().copied())
        .unwrap_or("no reason is known")
}

/// An importer's text; `None` if the pointer is null or the text is not UTF-8.
///
/// # Safety
/// `text` is null, or ends with a zero byte and stays as it is while the result is used.
pub unsafe fn text<'a>(text: Text) -> Option<&'a str> {
    if text.is_null() {
        return None;
    }
    // SAFETY: it is not null, and by the contract above it ends with a zero byte and stays as it is.
    unsafe { CStr::from_ptr(text) }.to_str().ok()
}

/// An importer's array; `None` if the pointer is null although the array is not empty.
///
/// # Safety
/// `first` is null, or points to `count` values that stay as they are while the result is used.
pub unsafe fn array<'a, T>(first: *const T, count: usize) -> Result<&'a [T], Fault> {
    match (first.is_null(), count) {
        (_, 0) => Ok(&[]),
        (true, _) => Err(Fault::error(
            "an array is null; give as many values as are named",
        )),
        // SAFETY: it is not null, and by the contract above it has so many values that stay as they are.
        (false, _) => Ok(unsafe { std::slice::from_raw_parts(first, count) }),
    }
}

/// An importer's array that is written to; an error if the pointer is null although the array is not empty.
///
/// # Safety
/// `first` is null, or points to `count` values that nobody else uses while the result is used.
pub unsafe fn array_mut<'a, T>(first: *mut T, count: usize) -> Result<&'a mut [T], Fault> {
    match (first.is_null(), count) {
        (_, 0) => Ok(&mut []),
        (true, _) => Err(Fault::error(
            "an array is null; give room for as many values as are named",
        )),
        // SAFETY: it is not null, and by the contract above it has so many values that nobody else uses.
        (false, _) => Ok(unsafe { std::slice::from_raw_parts_mut(first, count) }),
    }
}
