//! From instantiation to the end.

use std::ffi::{c_char, c_int};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use super::guard::{array, call, said, text};
use super::instance::{Fault, Instance, Phase};
use super::logger::Logger;
use super::types::{Boolean, CO_SIMULATION, Callbacks, FALSE, Handle, Status, Text};
use crate::component::Refusal;
use crate::content::Content;
use crate::description::LOG_CATEGORIES;
use crate::location;

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
    _visible: Boolean,
    _logging_on: Boolean,
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
    let logger = Logger::new(
        callbacks.and_then(|callbacks| callbacks.logger),
        name.unwrap_or_default(),
        callbacks.map_or(std::ptr::null_mut(), |callbacks| callbacks.environment),
    );
    let make = || {
        if fmu_type != CO_SIMULATION {
            return Err(
                "it is for model exchange; this unit is for co-simulation alone".to_owned(),
            );
        }
        let uri = resources.ok_or("the place of the resources is missing; give a file URI")?;
        let folder = location::path(uri)?;
        make_instance(name, guid, &folder, logger.clone())
    };
    let result = catch_unwind(AssertUnwindSafe(make))
        .unwrap_or_else(|panic| Err(format!("the instance cannot be made: {}", said(&*panic))));
    match result {
        Ok(instance) => Box::into_raw(Box::new(instance)).cast(),
        Err(why) => {
            let log = || logger.write(Status::Error, &format!("fmi2Instantiate: {why}"));
            let _ = catch_unwind(AssertUnwindSafe(log));
            std::ptr::null_mut()
        }
    }
}

/// Makes an instance of the content of a folder.
///
/// # Errors
/// If it has no name, the content is wrong, or its checksum is another one; what is wrong and how to correct it.
fn make_instance(
    name: Option<&str>,
    guid: Option<&str>,
    resources: &Path,
    logger: Logger,
) -> Result<Instance, String> {
    if name.is_none_or(str::is_empty) {
        return Err("the instance has no name; give one in UTF-8".to_owned());
    }
    let content = Content::read(resources).map_err(|error| error.to_string())?;
    if guid != Some(content.guid.as_str()) {
        return Err(format!(
            "the GUID is {guid:?}, but that of the library with these resources is {}; export the unit again",
            content.guid
        ));
    }
    Ok(Instance::new(content.component, logger))
}

/// Frees an instance.
///
/// # Safety
/// `component` is null or an instance that is not used any more.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2FreeInstance(component: Handle) {
    if component.is_null() {
        return;
    }
    // SAFETY: it is not null, so it was made by `made` from a box, and the importer frees it once.
    let instance = unsafe { Box::from_raw(component.cast::<Instance>()) };
    let _ = catch_unwind(AssertUnwindSafe(|| drop(instance)));
}

/// Switches debug messages; there are none, so it only checks the categories.
///
/// # Safety
/// As the standard says: `component` is an instance, and `categories` are so many texts.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetDebugLogging(
    component: Handle,
    _logging_on: Boolean,
    count: usize,
    categories: *const Text,
) -> Status {
    let check = |_: &mut Instance| {
        // SAFETY: the importer gives null or has so many texts, each null or ending with a zero byte.
        let names = unsafe { array(categories, count)?.iter().map(|name| text(*name)) };
        let mut unknown =
            names.filter(|name| !name.is_some_and(|name| LOG_CATEGORIES.contains(&name)));
        match unknown.next() {
            None => Ok(()),
            Some(name) => Err(Fault::error(format!(
                "category {name:?} is not known; there are {LOG_CATEGORIES:?}"
            ))),
        }
    };
    // SAFETY: the importer gives null or an instance, and calls one function at a time.
    unsafe { call(component, "fmi2SetDebugLogging", check) }
}

/// Sets when the simulation begins and ends. Tolerances are not used: the plant chooses its own steps.
///
/// # Safety
/// As the standard says: `component` is an instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetupExperiment(
    component: Handle,
    _tolerance_defined: Boolean,
    _tolerance: f64,
    start_time: f64,
    stop_time_defined: Boolean,
    stop_time: f64,
) -> Status {
    let set = |instance: &mut Instance| {
        instance.only_in(&[Phase::Instantiated])?;
        let stop_s = (stop_time_defined != FALSE).then_some(stop_time);
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
    let exit = |instance: &mut Instance| {
        instance.only_in(&[Phase::Initialising])?;
        if let Err(Refusal(why)) = instance.initialise() {
            instance.enter(Phase::Failed);
            return Err(Fault::error(why));
        }
        instance.enter(Phase::Stepping);
        Ok(())
    };
    // SAFETY: the importer gives null or an instance, and calls one function at a time.
    unsafe { call(component, "fmi2ExitInitializationMode", exit) }
}

/// Ends the simulation.
///
/// # Safety
/// As the standard says: `component` is an instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Terminate(component: Handle) -> Status {
    let terminate = |instance: &mut Instance| {
        instance.only_in(&[Phase::Stepping, Phase::Failed])?;
        instance.enter(Phase::Terminated);
        Ok(())
    };
    // SAFETY: the importer gives null or an instance, and calls one function at a time.
    unsafe { call(component, "fmi2Terminate", terminate) }
}

/// Sets an instance back to how it was made.
///
/// # Safety
/// As the standard says: `component` is an instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Reset(component: Handle) -> Status {
    let reset = |instance: &mut Instance| {
        instance.reset();
        Ok(())
    };
    // SAFETY: the importer gives null or an instance, and calls one function at a time.
    unsafe { call(component, "fmi2Reset", reset) }
}
