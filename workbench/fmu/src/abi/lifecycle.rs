//! From instantiation to the end, as both versions do it.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use super::guard::{array, call, said, text};
use super::instance::{Fault, Instance, Phase};
use super::logger::Logger;
use super::types::{Handle, Status, Text};
use crate::component::Refusal;
use crate::content::Content;
use crate::description::LOG_CATEGORIES;
use crate::version::Version;

/// Calls `make`; its instance for the importer, or null with a message.
pub fn made(
    function: &str,
    logger: &Logger,
    make: impl FnOnce() -> Result<Instance, String>,
) -> Handle {
    let result = catch_unwind(AssertUnwindSafe(make))
        .unwrap_or_else(|panic| Err(format!("the instance cannot be made: {}", said(&*panic))));
    match result {
        Ok(instance) => Box::into_raw(Box::new(instance)).cast(),
        Err(why) => {
            let log = || logger.write(Status::Error, &format!("{function}: {why}"));
            let _ = catch_unwind(AssertUnwindSafe(log));
            std::ptr::null_mut()
        }
    }
}

/// Makes an instance of the content of a folder.
///
/// # Errors
/// If it has no name, the content is wrong, or its checksum is another one; what is wrong and how to mend it.
pub fn instance(
    version: Version,
    name: Option<&str>,
    guid: Option<&str>,
    resources: &Path,
    logger: Logger,
) -> Result<Instance, String> {
    if name.is_none_or(str::is_empty) {
        return Err("the instance has no name; give one in UTF-8".to_owned());
    }
    let content = Content::read(version, resources).map_err(|error| error.to_string())?;
    if guid != Some(content.guid.as_str()) {
        return Err(format!(
            "the {} is {guid:?}, but that of the library with these resources is {}; export the unit again",
            match version {
                Version::Two => "GUID",
                Version::Three => "instantiation token",
            },
            content.guid
        ));
    }
    Ok(Instance::new(version, content.component, logger))
}

/// Frees an instance.
///
/// # Safety
/// `instance` is null or an instance that is not used any more.
pub unsafe fn free(instance: Handle) {
    if instance.is_null() {
        return;
    }
    // SAFETY: it is not null, so it was made by `made` from a box, and the importer frees it once.
    let instance = unsafe { Box::from_raw(instance.cast::<Instance>()) };
    let _ = catch_unwind(AssertUnwindSafe(|| drop(instance)));
}

/// Switches debug messages; there are none, so it only checks the categories.
///
/// # Safety
/// `instance` is null or an instance; `categories` is null or has so many elements, each null or a text.
pub unsafe fn debug_logging(
    instance: Handle,
    function: &str,
    (categories, count): (*const Text, usize),
) -> Status {
    let check = |_: &mut Instance| {
        // SAFETY: by the contract above, it is null or has so many texts, each null or ending with a zero byte.
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
    // SAFETY: by the contract above, it is null or an instance.
    unsafe { call(instance, function, check) }
}

/// Ends initialisation: the component begins with the values that were set.
///
/// # Safety
/// `instance` is null or an instance.
pub unsafe fn exit_initialisation(instance: Handle, function: &str) -> Status {
    let exit = |instance: &mut Instance| {
        instance.only_in(&[Phase::Initialising])?;
        if let Err(Refusal(why)) = instance.initialise() {
            instance.enter(Phase::Failed);
            return Err(Fault::error(why));
        }
        instance.enter(Phase::Stepping);
        Ok(())
    };
    // SAFETY: by the contract above, it is null or an instance.
    unsafe { call(instance, function, exit) }
}

/// Ends the simulation.
///
/// # Safety
/// `instance` is null or an instance.
pub unsafe fn terminate(instance: Handle, function: &str) -> Status {
    let terminate = |instance: &mut Instance| {
        instance.only_in(&[Phase::Stepping, Phase::Failed])?;
        instance.enter(Phase::Terminated);
        Ok(())
    };
    // SAFETY: by the contract above, it is null or an instance.
    unsafe { call(instance, function, terminate) }
}

/// Sets an instance back to how it was made.
///
/// # Safety
/// `instance` is null or an instance.
pub unsafe fn reset(instance: Handle, function: &str) -> Status {
    let reset = |instance: &mut Instance| {
        instance.reset();
        Ok(())
    };
    // SAFETY: by the contract above, it is null or an instance.
    unsafe { call(instance, function, reset) }
}
