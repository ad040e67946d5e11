//! Reading and setting values of variables of any type.

use super::guard::{array, array_mut, call};
use super::instance::{Fault, Instance, Phase};
use super::types::{Handle, Status, ValueReference};
use crate::variable::Value;

/// Where values can be set.
pub const SETTABLE: [Phase; 3] = [Phase::Instantiated, Phase::Initialising, Phase::Stepping];

/// The importer's list of variables.
pub type References = (*const ValueReference, usize);

/// Message for a variable of another type.
pub fn other_type(reference: ValueReference) -> Fault {
    Fault::error(format!(
        "value reference {reference} has another type; see modelDescription.xml"
    ))
}

/// Reads variables into the importer's array; `as_type` gives the value in the array's type.
///
/// # Safety
/// `instance` is null or an instance; the arrays are null or have `count` places.
pub unsafe fn get<T>(
    instance: Handle,
    function: &str,
    (references, count): References,
    values: *mut T,
    as_type: impl Fn(&Value) -> Option<T>,
) -> Status {
    let read = |instance: &mut Instance| {
        // SAFETY: by the contract above, the arrays are null or have so many places.
        let (references, places) =
            unsafe { (array(references, count)?, array_mut(values, count)?) };
        for (reference, place) in references.iter().zip(places) {
            let value = as_type(instance.get(*reference)?);
            *place = value.ok_or_else(|| other_type(*reference))?;
        }
        Ok(())
    };
    // SAFETY: by the contract above, it is null or an instance.
    unsafe { call(instance, function, read) }
}

/// Sets variables to the importer's values; `of_type` makes a value of an element of the array.
///
/// # Safety
/// `instance` is null or an instance; the arrays are null or have `count` elements.
pub unsafe fn set<T: Copy>(
    instance: Handle,
    function: &str,
    (references, count): References,
    values: *const T,
    of_type: impl Fn(T) -> Value,
) -> Status {
    let write = |instance: &mut Instance| {
        instance.only_in(&SETTABLE)?;
        // SAFETY: by the contract above, the arrays are null or have so many elements.
        let (references, values) = unsafe { (array(references, count)?, array(values, count)?) };
        for (reference, value) in references.iter().zip(values) {
            instance.set(*reference, of_type(*value))?;
        }
        Ok(())
    };
    // SAFETY: by the contract above, it is null or an instance.
    unsafe { call(instance, function, write) }
}
