//! Values of variables.

use std::ffi::c_int;

use super::types::{FMI2_FALSE, Fmi2Boolean};
use crate::abi::access::{SETTABLE, get, get_texts, set, set_texts};
use crate::abi::guard::{array, call};
use crate::abi::instance::{Fault, Instance};
use crate::abi::types::{Handle, Status, Text, ValueReference};
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
    component: Handle,
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
    component: Handle,
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
    component: Handle,
    references: *const ValueReference,
    count: usize,
    values: *mut Text,
) -> Status {
    // SAFETY: the importer gives null or an instance, and arrays of this size.
    unsafe { get_texts(component, "fmi2GetString", (references, count), values) }
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
    // SAFETY: the importer gives null or an instance, and arrays of this size.
    unsafe { set_texts(component, "fmi2SetString", (references, count), values) }
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
