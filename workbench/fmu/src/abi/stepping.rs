//! Steps and their status. Every step is synchronous.

use std::ffi::c_int;

use super::guard::call;
use super::instance::{Fault, Instance, Phase};
use super::types::{Boolean, FALSE, Handle, Status, Text};

/// `fmi2StatusKind` of the time up to which the last step was taken.
const LAST_SUCCESSFUL_TIME: c_int = 2;
/// `fmi2StatusKind` of whether the instance wants to end the simulation.
const TERMINATED: c_int = 3;

/// Takes a step. A step that is refused changes nothing: a shorter one may follow.
///
/// # Safety
/// As the standard says: `component` is an instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2DoStep(
    component: Handle,
    current_communication_point: f64,
    communication_step_size: f64,
    _no_set_state_prior_to_current_point: Boolean,
) -> Status {
    let step = |instance: &mut Instance| {
        instance.only_in(&[Phase::Stepping])?;
        instance.step(current_communication_point, communication_step_size)
    };
    // SAFETY: the importer gives null or an instance, and calls one function at a time.
    unsafe { call(component, "fmi2DoStep", step) }
}

/// There is never a step to be cancelled.
///
/// # Safety
/// As the standard says: `component` is an instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2CancelStep(component: Handle) -> Status {
    // SAFETY: the importer gives null or an instance, and calls one function at a time.
    unsafe {
        call(component, "fmi2CancelStep", |_| {
            Err(Fault::error("no step is under way: steps are synchronous"))
        })
    }
}

/// Answers a question about the last step, or refuses it.
///
/// # Safety
/// `component` is null or an instance; `value` is null or a place for the answer.
unsafe fn answer<T>(
    component: Handle,
    function: &str,
    value: *mut T,
    question: impl FnOnce(&Instance) -> Option<T>,
) -> Status {
    let act = |instance: &mut Instance| {
        let known = question(instance)
            .ok_or_else(|| Fault::discard("this is not known: steps are synchronous"))?;
        // SAFETY: by the contract above, it is null or a place for the answer.
        let place = unsafe { value.as_mut() };
        *place.ok_or_else(|| Fault::error("the place for the answer is null"))? = known;
        Ok(())
    };
    // SAFETY: by the contract above, it is null or an instance.
    unsafe { call(component, function, act) }
}

/// Status of an asynchronous step; there is none.
///
/// # Safety
/// As the standard says: `component` is an instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetStatus(
    component: Handle,
    _kind: c_int,
    value: *mut Status,
) -> Status {
    // SAFETY: the importer gives null or an instance, and null or a place for the answer.
    unsafe { answer(component, "fmi2GetStatus", value, |_| None) }
}

/// The time up to which the last step was taken, s.
///
/// # Safety
/// As the standard says: `component` is an instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetRealStatus(
    component: Handle,
    kind: c_int,
    value: *mut f64,
) -> Status {
    let time = |instance: &Instance| (kind == LAST_SUCCESSFUL_TIME).then(|| instance.time_s());
    // SAFETY: the importer gives null or an instance, and null or a place for the answer.
    unsafe { answer(component, "fmi2GetRealStatus", value, time) }
}

/// There is no status that is a whole number.
///
/// # Safety
/// As the standard says: `component` is an instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetIntegerStatus(
    component: Handle,
    _kind: c_int,
    value: *mut c_int,
) -> Status {
    // SAFETY: the importer gives null or an instance, and null or a place for the answer.
    unsafe { answer(component, "fmi2GetIntegerStatus", value, |_| None) }
}

/// Whether the instance wants to end the simulation: never.
///
/// # Safety
/// As the standard says: `component` is an instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetBooleanStatus(
    component: Handle,
    kind: c_int,
    value: *mut Boolean,
) -> Status {
    let ends = |_: &Instance| (kind == TERMINATED).then_some(FALSE);
    // SAFETY: the importer gives null or an instance, and null or a place for the answer.
    unsafe { answer(component, "fmi2GetBooleanStatus", value, ends) }
}

/// Text about an asynchronous step; there is none.
///
/// # Safety
/// As the standard says: `component` is an instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetStringStatus(
    component: Handle,
    _kind: c_int,
    value: *mut Text,
) -> Status {
    // SAFETY: the importer gives null or an instance, and null or a place for the answer.
    unsafe { answer(component, "fmi2GetStringStatus", value, |_| None) }
}
