//! From instantiation to the end.

use std::ffi::c_char;
use std::path::Path;

use super::types::{Environment, FMI3_FALSE, Fmi3Boolean, Unused};
use crate::abi::guard::{call, text};
use crate::abi::instance::{Instance, Phase};
use crate::abi::lifecycle;
use crate::abi::logger::{Logger, MessageFunction, Sink};
use crate::abi::types::{Handle, Status, Text, ValueReference};
use crate::version::Version;

/// Version of the standard.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetVersion() -> *const c_char {
    c"3.0".as_ptr()
}

fn logger(function: Option<MessageFunction>, environment: Environment) -> Logger {
    Logger::new(function.map_or(Sink::Nowhere, Sink::Message), environment)
}

/// Makes an instance; null if something is wrong, with a message.
///
/// # Safety
/// As the standard says: texts end with a zero byte, and the function can be called until the instance is freed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3InstantiateCoSimulation(
    instance_name: Text,
    instantiation_token: Text,
    resource_path: Text,
    _visible: Fmi3Boolean,
    _logging_on: Fmi3Boolean,
    event_mode_used: Fmi3Boolean,
    _early_return_allowed: Fmi3Boolean,
    _required_intermediate_variables: *const ValueReference,
    required_intermediate_variable_count: usize,
    environment: Environment,
    log_message: Option<MessageFunction>,
    _intermediate_update: Unused,
) -> Handle {
    // SAFETY: the importer gives null or texts that end with a zero byte, and keeps them during the call.
    let [name, token, resources] = unsafe {
        [
            text(instance_name),
            text(instantiation_token),
            text(resource_path),
        ]
    };
    let logger = logger(log_message, environment);
    let make = || {
        if event_mode_used != FMI3_FALSE {
            return Err(
                "it is to use events; hasEventMode is false in modelDescription.xml".into(),
            );
        }
        if required_intermediate_variable_count > 0 {
            let flag = "providesIntermediateUpdate is false in modelDescription.xml";
            return Err(format!("it is to give values within a step; {flag}"));
        }
        let folder = resources
            .filter(|path| Path::new(path).is_absolute())
            .ok_or("the place of the resources is missing; give an absolute path in UTF-8")?;
        let folder = Path::new(folder);
        lifecycle::instance(Version::Three, name, token, folder, logger.clone())
    };
    lifecycle::made("fmi3InstantiateCoSimulation", &logger, make)
}

const CO_SIMULATION_ALONE: &str = "this unit is for co-simulation alone";

/// There is no model exchange: null, with a message.
///
/// # Safety
/// As the standard says: the function for messages can be called.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3InstantiateModelExchange(
    _instance_name: Text,
    _instantiation_token: Text,
    _resource_path: Text,
    _visible: Fmi3Boolean,
    _logging_on: Fmi3Boolean,
    environment: Environment,
    log_message: Option<MessageFunction>,
) -> Handle {
    let refuse = || Err(CO_SIMULATION_ALONE.to_owned());
    let logger = logger(log_message, environment);
    lifecycle::made("fmi3InstantiateModelExchange", &logger, refuse)
}

/// There is no scheduled execution: null, with a message.
///
/// # Safety
/// As the standard says: the function for messages can be called.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3InstantiateScheduledExecution(
    _instance_name: Text,
    _instantiation_token: Text,
    _resource_path: Text,
    _visible: Fmi3Boolean,
    _logging_on: Fmi3Boolean,
    environment: Environment,
    log_message: Option<MessageFunction>,
    _clock_update: Unused,
    _lock_preemption: Unused,
    _unlock_preemption: Unused,
) -> Handle {
    let refuse = || Err(CO_SIMULATION_ALONE.to_owned());
    let logger = logger(log_message, environment);
    lifecycle::made("fmi3InstantiateScheduledExecution", &logger, refuse)
}

/// Frees an instance.
///
/// # Safety
/// `instance` is null or an instance that is not used any more.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3FreeInstance(instance: Handle) {
    // SAFETY: the importer gives null or an instance, and frees it once.
    unsafe { lifecycle::free(instance) }
}

/// Switches debug messages; there are none, so it only checks the categories.
///
/// # Safety
/// As the standard says: `instance` is an instance, and `categories` are so many texts.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetDebugLogging(
    instance: Handle,
    _logging_on: Fmi3Boolean,
    count: usize,
    categories: *const Text,
) -> Status {
    // SAFETY: the importer gives null or an instance, and null or so many texts.
    unsafe { lifecycle::debug_logging(instance, "fmi3SetDebugLogging", (categories, count)) }
}

/// Sets when the simulation begins and ends, and begins initialisation. Tolerances are not used: the plant chooses its
/// own steps.
///
/// # Safety
/// As the standard says: `instance` is an instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3EnterInitializationMode(
    instance: Handle,
    _tolerance_defined: Fmi3Boolean,
    _tolerance: f64,
    start_time: f64,
    stop_time_defined: Fmi3Boolean,
    stop_time: f64,
) -> Status {
    let enter = |instance: &mut Instance| {
        instance.only_in(&[Phase::Instantiated])?;
        let stop_s = (stop_time_defined != FMI3_FALSE).then_some(stop_time);
        instance.set_times(start_time, stop_s)?;
        instance.enter(Phase::Initialising);
        Ok(())
    };
    // SAFETY: the importer gives null or an instance, and calls one function at a time.
    unsafe { call(instance, "fmi3EnterInitializationMode", enter) }
}

/// Ends initialisation: the component begins with the values that were set.
///
/// # Safety
/// As the standard says: `instance` is an instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3ExitInitializationMode(instance: Handle) -> Status {
    // SAFETY: the importer gives null or an instance, and calls one function at a time.
    unsafe { lifecycle::exit_initialisation(instance, "fmi3ExitInitializationMode") }
}

/// Ends the simulation.
///
/// # Safety
/// As the standard says: `instance` is an instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3Terminate(instance: Handle) -> Status {
    // SAFETY: the importer gives null or an instance, and calls one function at a time.
    unsafe { lifecycle::terminate(instance, "fmi3Terminate") }
}

/// Sets an instance back to how it was made.
///
/// # Safety
/// As the standard says: `instance` is an instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3Reset(instance: Handle) -> Status {
    // SAFETY: the importer gives null or an instance, and calls one function at a time.
    unsafe { lifecycle::reset(instance, "fmi3Reset") }
}
