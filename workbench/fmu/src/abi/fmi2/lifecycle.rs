//! From instantiation to the end.

use std::ffi::{c_char, c_int};

use super::types::{CO_SIMULATION, Callbacks, FMI2_FALSE, Fmi2Boolean};
use crate::abi::guard::{call, text};
use crate::abi::instance::{Instance, Phase};
use crate::abi::lifecycle;
use crate::abi::logger::{Logger, Sink, without_zeros};
use crate::abi::types::{Handle, Status, Text};
use crate::location;
use crate::version::Version;

/// Name of the platform's types.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetTypesPlatform() -> *const c_char {
    c"default".as_ptr()
}

/// Version of the standard.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetVersion() -> *const c_char {
    c"2.0".as_ptr()
}

/// Makes an instance; null if something is wrong, with a message.
///
/// # Safety
/// As the standard says: texts end with a zero byte, and the functions can be called until the instance is freed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Instantiate(
    instance_name: Text,
    fmu_type: c_int,
    fmu_guid: Text,
    fmu_resource_location: Text,
    functions: *const Callbacks,
    _visible: Fmi2Boolean,
    _logging_on: Fmi2Boolean,
) -> Handle {
    // SAFETY: the importer gives null or a structure of the standard.
    let callbacks = unsafe { functions.as_ref() };
    // SAFETY: the importer gives null or texts that end with a zero byte, and keeps them during the call.
    let [name, guid, resources] = unsafe {
        [
            text(instance_name),
            text(fmu_guid),
            text(fmu_resource_location),
        ]
    };
    let logger = match callbacks {
        Some(callbacks) => {
            let name = without_zeros(name.unwrap_or_default());
            let sink = callbacks.logger.map(|logger| Sink::Format(logger, name));
            Logger::new(sink.unwrap_or(Sink::Nowhere), callbacks.environment)
        }
        None => Logger::new(Sink::Nowhere, std::ptr::null_mut()),
    };
    let make = || {
        if fmu_type != CO_SIMULATION {
            return Err(
                "it is for model exchange; this unit is for co-simulation alone".to_owned(),
            );
        }
        let uri = resources.ok_or("the place of the resources is missing; give a file URI")?;
        let folder = location::path(uri)?;
        lifecycle::instance(Version::Two, name, guid, &folder, logger.clone())
    };
    lifecycle::made("fmi2Instantiate", &logger, make)
}

/// Frees an instance.
///
/// # Safety
/// `component` is null or an instance that is not used any more.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2FreeInstance(component: Handle) {
    // SAFETY: the importer gives null or an instance, and frees it once.
    unsafe { lifecycle::free(component) }
}

/// Switches debug messages; there are none, so it only checks the categories.
///
/// # Safety
/// As the standard says: `component` is an instance, and `categories` are so many texts.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetDebugLogging(
    component: Handle,
    _logging_on: Fmi2Boolean,
    count: usize,
    categories: *const Text,
) -> Status {
    // SAFETY: the importer gives null or an instance, and null or so many texts.
    unsafe { lifecycle::debug_logging(component, "fmi2SetDebugLogging", (categories, count)) }
}

/// Sets when the simulation begins and ends. Tolerances are not used: the plant chooses its own steps.
///
/// # Safety
/// As the standard says: `component` is an instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetupExperiment(
    component: Handle,
    _tolerance_defined: Fmi2Boolean,
    _tolerance: f64,
    start_time: f64,
    stop_time_defined: Fmi2Boolean,
    stop_time: f64,
) -> Status {
    let set = |instance: &mut Instance| {
        instance.only_in(&[Phase::Instantiated])?;
        let stop_s = (stop_time_defined != FMI2_FALSE).then_some(stop_time);
        instance.set_times(start_time, stop_s)
    };
    // SAFETY: the importer gives null or an instance, and calls one function at a time.
    unsafe { call(component, "fmi2SetupExperiment", set) }
}

/// Begins initialisation.
///
/// # Safety
/// As the standard says: `component` is an instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2EnterInitializationMode(component: Handle) -> Status {
    let enter = |instance: &mut Instance| {
        instance.only_in(&[Phase::Instantiated])?;
        instance.enter(Phase::Initialising);
        Ok(())
    };
    // SAFETY: the importer gives null or an instance, and calls one function at a time.
    unsafe { call(component, "fmi2EnterInitializationMode", enter) }
}

/// Ends initialisation: the component begins with the values that were set.
///
/// # Safety
/// As the standard says: `component` is an instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2ExitInitializationMode(component: Handle) -> Status {
    // SAFETY: the importer gives null or an instance, and calls one function at a time.
    unsafe { lifecycle::exit_initialisation(component, "fmi2ExitInitializationMode") }
}

/// Ends the simulation.
///
/// # Safety
/// As the standard says: `component` is an instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Terminate(component: Handle) -> Status {
    // SAFETY: the importer gives null or an instance, and calls one function at a time.
    unsafe { lifecycle::terminate(component, "fmi2Terminate") }
}

/// Sets an instance back to how it was made.
///
/// # Safety
/// As the standard says: `component` is an instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Reset(component: Handle) -> Status {
    // SAFETY: the importer gives null or an instance, and calls one function at a time.
    unsafe { lifecycle::reset(component, "fmi2Reset") }
}
