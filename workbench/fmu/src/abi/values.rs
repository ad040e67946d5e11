//! Values of variables.

use std::ffi::{c_char, c_int};

use super::guard::{array, array_mut, call, text};
use super::instance::{Fault, Instance, Phase};
use super::logger::without_zeros;
use super::types::{FMI2_FALSE, Fmi2Boolean, Fmi2Component, Fmi2String, Status, ValueReference};
use crate::variable::Value;

/// Where values can be set.
const SETTABLE: [Phase; 3] = [Phase::Instantiated, Phase::Initialising, Phase::Stepping];

/// Message for a variable of another type.
fn other_type(reference: ValueReference) -> Fault {
    Fault::error(format!(
        "value reference {reference} has another type; see modelDescription.xml"
    ))
}

/// Reads variables into the importer's array; `as_type` gives the value in the array's type.
///
/// # Safety
/// `component` is null or an instance; the arrays are null or have `count` places.
unsafe fn get<T>(
    component: Fmi2Component,
    function: &str,
    (references, count): (*const ValueReference, usize),
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
    unsafe { call(component, function, read) }
}

/// Sets variables to the importer's values; `of_type` makes a value of an element of the array.
///
/// # Safety
/// `component` is null or an instance; the arrays are null or have `count` elements.
unsafe fn set<T: Copy>(
    component: Fmi2Component,
    function: &str,
    (references, count): (*const ValueReference, usize),
    values: *const T,
    of_type: impl Fn(T) -> Option<Value>,
) -> Status {
    let write = |instance: &mut Instance| {
        instance.only_in(&SETTABLE)?;
        // SAFETY: by the contract above, the arrays are null or have so many elements.
        let (references, values) = unsafe { (array(references, count)?, array(values, count)?) };
        for (reference, value) in references.iter().zip(values) {
            let value =
                of_type(*value).ok_or_else(|| Fault::error("a text is null or not UTF-8"))?;
            instance.set(*reference, value)?;
        }
        Ok(())
    };
    // SAFETY: by the contract above, it is null or an instance.
    unsafe { call(component, function, write) }
}

/// Reads real numbers.
///
/// # Safety
/// As the standard says: `component` is an instance, and the arrays have so many places.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetReal(
    component: Fmi2Component,
    references: *const ValueReference,
    count: usize,
    values: *mut f64,
) -> Status {
    let as_type = |value: &Value| match value {
        Value::Real(value) => Some(*value),
        _ => None,
    };
    // SAFETY: the importer gives null or an instance, and arrays of this size.
    unsafe {
        get(
            component,
            "fmi2GetReal",
            (references, count),
            values,
            as_type,
        )
    }
}

/// Sets real numbers.
///
/// # Safety
/// As the standard says: `component` is an instance, and the arrays have so many elements.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetReal(
    component: Fmi2Component,
    references: *const ValueReference,
    count: usize,
    values: *const f64,
) -> Status {
    let of_type = |value| Some(Value::Real(value));
    // SAFETY: the importer gives null or an instance, and arrays of this size.
    unsafe {
        set(
            component,
            "fmi2SetReal",
            (references, count),
            values,
            of_type,
        )
    }
}

/// Reads whole numbers.
///
/// # Safety
/// As the standard says: `component` is an instance, and the arrays have so many places.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetInteger(
    component: Fmi2Component,
    references: *const ValueReference,
    count: usize,
    values: *mut c_int,
) -> Status {
    let as_type = |value: &Value| match value {
        Value::Integer(value) => Some(*value),
        _ => None,
    };
    // SAFETY: the importer gives null or an instance, and arrays of this size.
    unsafe {
        get(
            component,
            "fmi2GetInteger",
            (references, count),
            values,
            as_type,
        )
    }
}

/// Sets whole numbers.
///
/// # Safety
/// As the standard says: `component` is an instance, and the arrays have so many elements.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetInteger(
    component: Fmi2Component,
    references: *const ValueReference,
    count: usize,
    values: *const c_int,
) -> Status {
    let of_type = |value| Some(Value::Integer(value));
    // SAFETY: the importer gives null or an instance, and arrays of this size.
    unsafe {
        set(
            component,
            "fmi2SetInteger",
            (references, count),
            values,
            of_type,
        )
    }
}

/// Reads truth values.
///
/// # Safety
/// As the standard says: `component` is an instance, and the arrays have so many places.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetBoolean(
    component: Fmi2Component,
    references: *const ValueReference,
    count: usize,
    values: *mut Fmi2Boolean,
) -> Status {
    let as_type = |value: &Value| match value {
        Value::Boolean(value) => Some(Fmi2Boolean::from(*value)),
        _ => None,
    };
    // SAFETY: the importer gives null or an instance, and arrays of this size.
    unsafe {
        get(
            component,
            "fmi2GetBoolean",
            (references, count),
            values,
            as_type,
        )
    }
}

/// Sets truth values.
///
/// # Safety
/// As the standard says: `component` is an instance, and the arrays have so many elements.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetBoolean(
    component: Fmi2Component,
    references: *const ValueReference,
    count: usize,
    values: *const Fmi2Boolean,
) -> Status {
    let of_type = |value| Some(Value::Boolean(value != FMI2_FALSE));
    // SAFETY: the importer gives null or an instance, and arrays of this size.
    unsafe {
        set(
            component,
            "fmi2SetBoolean",
            (references, count),
            values,
            of_type,
        )
    }
}

/// Reads texts. They stay as they are until texts are read again or the instance is freed.
///
/// # Safety
/// As the standard says: `component` is an instance, and the arrays have so many places.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetString(
    component: Fmi2Component,
    references: *const ValueReference,
    count: usize,
    values: *mut *const c_char,
) -> Status {
    let read = |instance: &mut Instance| {
        // SAFETY: the importer gives null or arrays with so many places.
        let (references, places) =
            unsafe { (array(references, count)?, array_mut(values, count)?) };
        let mut texts = Vec::with_capacity(count);
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
    // SAFETY: the importer gives null or an instance, and calls one function at a time.
    unsafe { call(component, "fmi2GetString", read) }
}

/// Sets texts. No unit has one that can be set, so it refuses all but an empty list.
///
/// # Safety
/// As the standard says: `component` is an instance, and the arrays have so many elements.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetString(
    component: Fmi2Component,
    references: *const ValueReference,
    count: usize,
    values: *const Fmi2String,
) -> Status {
    // SAFETY: the importer gives null or texts that end with a zero byte.
    let of_type = |value| unsafe { text(value) }.map(|text| Value::Text(text.to_owned()));
    // SAFETY: the importer gives null or an instance, and arrays of this size.
    unsafe {
        set(
            component,
            "fmi2SetString",
            (references, count),
            values,
            of_type,
        )
    }
}

/// Sets first derivatives of inputs, 1/s, for the next step: inputs then change linearly within it.
///
/// # Safety
/// As the standard says: `component` is an instance, and the arrays have so many elements.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetRealInputDerivatives(
    component: Fmi2Component,
    references: *const ValueReference,
    count: usize,
    orders: *const c_int,
    values: *const f64,
) -> Status {
    let write = |instance: &mut Instance| {
        instance.only_in(&SETTABLE)?;
        // SAFETY: the importer gives null or arrays with so many elements.
        let (references, orders, values) = unsafe {
            (
                array(references, count)?,
                array(orders, count)?,
                array(values, count)?,
            )
        };
        for ((reference, order), value) in references.iter().zip(orders).zip(values) {
            if *order != 1 {
                return Err(Fault::error(format!(
                    "the derivative of order {order} is not known; give first derivatives"
                )));
            }
            instance.set_slope(*reference, *value)?;
        }
        Ok(())
    };
    // SAFETY: the importer gives null or an instance, and calls one function at a time.
    unsafe { call(component, "fmi2SetRealInputDerivatives", write) }
}

/// Derivatives of outputs are not known.
///
/// # Safety
/// As the standard says: `component` is an instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetRealOutputDerivatives(
    component: Fmi2Component,
    _references: *const ValueReference,
    _count: usize,
    _orders: *const c_int,
    _values: *mut f64,
) -> Status {
    // SAFETY: the importer gives null or an instance, and calls one function at a time.
    unsafe {
        call(component, "fmi2GetRealOutputDerivatives", |_| {
            Err(Fault::error(
                "is not supported: maxOutputDerivativeOrder is 0",
            ))
        })
    }
}
