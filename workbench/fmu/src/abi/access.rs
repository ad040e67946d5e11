//! Values of variables, as both versions read and set them.

use super::guard::{array, array_mut, call, text};
use super::instance::{Fault, Instance, Phase};
use super::logger::without_zeros;
use super::types::{Handle, Status, Text, ValueReference};
use crate::variable::Value;

/// Where values can be set.
pub const SETTABLE: [Phase; 3] = [Phase::Instantiated, Phase::Initialising, Phase::Stepping];

/// The importer's list of variables.
pub type References = (*const ValueReference, usize);

/// Message for a variable of another type.
fn other_type(reference: ValueReference) -> Fault {
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

/// Sets variables to the importer's values; `of_type` makes a value of an element of the array, or `None` if no variable
/// has its type.
///
/// # Safety
/// `instance` is null or an instance; the arrays are null or have `count` elements.
pub unsafe fn set<T: Copy>(
    instance: Handle,
    function: &str,
    (references, count): References,
    values: *const T,
    of_type: impl Fn(T) -> Option<Value>,
) -> Status {
    let write = |instance: &mut Instance| {
        instance.only_in(&SETTABLE)?;
        // SAFETY: by the contract above, the arrays are null or have so many elements.
        let (references, values) = unsafe { (array(references, count)?, array(values, count)?) };
        for (reference, value) in references.iter().zip(values) {
            let value = of_type(*value).ok_or_else(|| other_type(*reference))?;
            instance.set(*reference, value)?;
        }
        Ok(())
    };
    // SAFETY: by the contract above, it is null or an instance.
    unsafe { call(instance, function, write) }
}

/// Reads texts. They stay as they are until texts are read again or the instance is freed.
///
/// # Safety
/// `instance` is null or an instance; the arrays are null or have `count` places.
pub unsafe fn get_texts(
    instance: Handle,
    function: &str,
    (references, count): References,
    values: *mut Text,
) -> Status {
    let read = |instance: &mut Instance| {
        // SAFETY: by the contract above, the arrays are null or have so many places.
        let (references, places) =
            unsafe { (array(references, count)?, array_mut(values, count)?) };
        let mut texts = Vec::with_capacity(references.len());
        for reference in references {
            match instance.get(*reference)? {
                Value::Text(text) => texts.push(without_zeros(text)),
                _ => return Err(other_type(*reference)),
            }
        }
        instance.texts = texts;
        for (place, text) in places.iter_mut().zip(&instance.texts) {
            *place = text.as_ptr();
        }
        Ok(())
    };
    // SAFETY: by the contract above, it is null or an instance.
    unsafe { call(instance, function, read) }
}

/// Sets texts. No unit has one that can be set, so it refuses all but an empty list.
///
/// # Safety
/// `instance` is null or an instance; the arrays are null or have `count` elements, each null or a text.
pub unsafe fn set_texts(
    instance: Handle,
    function: &str,
    (references, count): References,
    values: *const Text,
) -> Status {
    let write = |instance: &mut Instance| {
        instance.only_in(&SETTABLE)?;
        // SAFETY: by the contract above, the arrays are null or have so many elements.
        let (references, values) = unsafe { (array(references, count)?, array(values, count)?) };
        for (reference, value) in references.iter().zip(values) {
            // SAFETY: by the contract above, it is null or a text that ends with a zero byte.
            let value = unsafe { text(*value) };
            let value = value.ok_or_else(|| Fault::error("a text is null or not UTF-8"))?;
            instance.set(*reference, Value::Text(value.to_owned()))?;
        }
        Ok(())
    };
    // SAFETY: by the contract above, it is null or an instance.
    unsafe { call(instance, function, write) }
}
