//! Values of variables.

use std::ffi::c_int;

use super::access::{SETTABLE, get, other_type, set};
use super::guard::{array, array_mut, call, text};
use super::instance::{Fault, Instance};
use super::logger::without_zeros;
use super::types::{Boolean, FALSE, Handle, Status, Text, ValueReference};
use crate::variable::Value;

/// Reads real numbers.
///
/// # Safety
/// As the standard says: `component` is an instance, and the arrays have so many places.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetReal(
    component: Handle,
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
    component: Handle,
    references: *const ValueReference,
    count: usize,
    values: *const f64,
) -> Status {
    let of_type = |value| Value::Real(value);
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
    component: Handle,
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
    component: Handle,
    references: *const ValueReference,
    count: usize,
    values: *const c_int,
) -> Status {
    let of_type = |value| Value::Integer(value);
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
    component: Handle,
    references: *const ValueReference,
    count: usize,
    values: *mut Boolean,
) -> Status {
    let as_type = |value: &Value| match value {
        Value::Boolean(value) => Some(Boolean::from(*value)),
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
    component: Handle,
    references: *const ValueReference,
    count: usize,
    values: *const Boolean,
) -> Status {
    let of_type = |value| Value::Boolean(value != FALSE);
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
    component: Handle,
    references: *const ValueReference,
    count: usize,
    values: *mut Text,
) -> Status {
    let read = |instance: &mut Instance| {
        // SAFETY: the importer gives null or arrays with so many places.
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
    // SAFETY: the importer gives null or an instance, and calls one function at a time.
    unsafe { call(component, "fmi2GetString", read) }
}

/// Sets texts. No unit has one that can be set, so it refuses all but an empty list.
///
/// # Safety
/// As the standard says: `component` is an instance, and the arrays have so many elements.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetString(
    component: Handle,
    references: *const ValueReference,
    count: usize,
    values: *const Text,
) -> Status {
    let write = |instance: &mut Instance| {
        instance.only_in(&SETTABLE)?;
        // SAFETY: the importer gives null or arrays with so many elements.
        let (references, values) = unsafe { (array(references, count)?, array(values, count)?) };
        for (reference, value) in references.iter().zip(values) {
            // SAFETY: the importer gives null or a text that ends with a zero byte.
            let value = unsafe { text(*value) };
            let value = value.ok_or_else(|| Fault::error("a text is null or not UTF-8"))?;
            instance.set(*reference, Value::Text(value.to_owned()))?;
        }
        Ok(())
    };
    // SAFETY: the importer gives null or an instance, and calls one function at a time.
    unsafe { call(component, "fmi2SetString", write) }
}

/// Sets first derivatives of inputs, 1/s, for the next step: inputs then change linearly within it.
///
/// # Safety
/// As the standard says: `component` is an instance, and the arrays have so many elements.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetRealInputDerivatives(
    component: Handle,
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
    component: Handle,
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
