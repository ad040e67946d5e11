//! Steps. Each is complete when the call returns: there are no events, and no step returns early.

use super::types::{FMI3_FALSE, Fmi3Boolean};
use crate::abi::guard::call;
use crate::abi::instance::{Fault, Instance, Phase};
use crate::abi::types::{Handle, Status};

/// Takes a step. A step that is refused changes nothing: a shorter one may follow.
///
/// # Safety
/// As the standard says: `instance` is an instance, and the pointers are places for the answers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3DoStep(
    instance: Handle,
    current_communication_point: f64,
    communication_step_size: f64,
    _no_set_state_prior_to_current_point: Fmi3Boolean,
    event_handling_needed: *mut Fmi3Boolean,
    terminate_simulation: *mut Fmi3Boolean,
    early_return: *mut Fmi3Boolean,
    last_successful_time: *mut f64,
) -> Status {
    let step = |instance: &mut Instance| {
        let flags = [event_handling_needed, terminate_simulation, early_return];
        if last_successful_time.is_null() || flags.iter().any(|flag| flag.is_null()) {
            return Err(Fault::error("a place for an answer is null; give all four"));
        }
        let taken = instance
            .only_in(&[Phase::Stepping])
            .and_then(|()| instance.step(current_communication_point, communication_step_size));
        for flag in flags {
            // SAFETY: it is not null, so the importer gives a place for a truth value.
            unsafe { flag.write(FMI3_FALSE) };
        }
        // SAFETY: it is not null, so the importer gives a place for a real number.
        unsafe { last_successful_time.write(instance.time_s()) };
        taken
    };
    // SAFETY: the importer gives null or an instance, and calls one function at a time.
    unsafe { call(instance, "fmi3DoStep", step) }
}
