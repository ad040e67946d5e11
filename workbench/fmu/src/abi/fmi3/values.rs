//! Values of variables.

use super::types::{FMI3_FALSE, Fmi3Boolean};
use crate::abi::access::{get, get_texts, set, set_texts};
use crate::abi::guard::call;
use crate::abi::instance::Fault;
use crate::abi::types::{Handle, Status, Text, ValueReference};
use crate::variable::Value;

/// Refuses a list of values that is not as long as that of the variables: every variable is a scalar.
///
/// # Safety
/// `instance` is null or an instance.
unsafe fn lengths_differ(instance: Handle, function: &str, counts: [usize; 2]) -> Status {
    let [references, values] = counts;
    let refuse = || {
        Err(Fault::error(format!(
            "{references} variables and {values} values; every variable has one"
        )))
    };
    // SAFETY: by the contract above, it is null or an instance.
    unsafe { call(instance, function, |_| refuse()) }
}

/// Functions that read and set the variables of a type.
macro_rules! functions_of_type {
    ($($get:ident, $set:ident: $type:ty, $what:literal, $as_type:expr, $of_type:expr;)*) => {$(
        #[doc = concat!("Reads ", $what, ".")]
        ///
        /// # Safety
        /// As the standard says: `instance` is an instance, and the arrays have so many places.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $get(
            instance: Handle,
            references: *const ValueReference,
            count: usize,
            values: *mut $type,
            value_count: usize,
        ) -> Status {
            const NAME: &str = stringify!($get);
            let as_type: fn(&Value) -> Option<$type> = $as_type;
            // SAFETY: the importer gives null or an instance, and arrays of these sizes.
            unsafe {
                match count == value_count {
                    true => get(instance, NAME, (references, count), values, as_type),
                    false => lengths_differ(instance, NAME, [count, value_count]),
                }
            }
        }

        #[doc = concat!("Sets ", $what, ".")]
        ///
        /// # Safety
        /// As the standard says: `instance` is an instance, and the arrays have so many elements.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $set(
            instance: Handle,
            references: *const ValueReference,
            count: usize,
            values: *const $type,
            value_count: usize,
        ) -> Status {
            const NAME: &str = stringify!($set);
            let of_type: fn($type) -> Option<Value> = $of_type;
            // SAFETY: the importer gives null or an instance, and arrays of these sizes.
            unsafe {
                match count == value_count {
                    true => set(instance, NAME, (references, count), values, of_type),
                    false => lengths_differ(instance, NAME, [count, value_count]),
                }
            }
        }
    )*};
}

fn real(value: &Value) -> Option<f64> {
    match value {
        Value::Real(value) => Some(*value),
        _ => None,
    }
}

fn integer(value: &Value) -> Option<i32> {
    match value {
        Value::Integer(value) => Some(*value),
        _ => None,
    }
}

fn boolean(value: &Value) -> Option<Fmi3Boolean> {
    match value {
        Value::Boolean(value) => Some(Fmi3Boolean::from(*value)),
        _ => None,
    }
}

functions_of_type! {
    fmi3GetFloat64, fmi3SetFloat64: f64, "real numbers", real, |value| Some(Value::Real(value));
    fmi3GetInt32, fmi3SetInt32: i32, "whole numbers", integer, |value| Some(Value::Integer(value));
    fmi3GetBoolean, fmi3SetBoolean: Fmi3Boolean, "truth values", boolean,
        |value| Some(Value::Boolean(value != FMI3_FALSE));
    fmi3GetFloat32, fmi3SetFloat32: f32, "real numbers of 32 bits; there are none", |_| None, |_| None;
    fmi3GetInt8, fmi3SetInt8: i8, "whole numbers of 8 bits; there are none", |_| None, |_| None;
    fmi3GetUInt8, fmi3SetUInt8: u8, "natural numbers of 8 bits; there are none", |_| None, |_| None;
    fmi3GetInt16, fmi3SetInt16: i16, "whole numbers of 16 bits; there are none", |_| None, |_| None;
    fmi3GetUInt16, fmi3SetUInt16: u16, "natural numbers of 16 bits; there are none", |_| None, |_| None;
    fmi3GetUInt32, fmi3SetUInt32: u32, "natural numbers of 32 bits; there are none", |_| None, |_| None;
    fmi3GetInt64, fmi3SetInt64: i64, "whole numbers of 64 bits; there are none", |_| None, |_| None;
    fmi3GetUInt64, fmi3SetUInt64: u64, "natural numbers of 64 bits; there are none", |_| None, |_| None;
}

/// Reads texts. They stay as they are until texts are read again or the instance is freed.
///
/// # Safety
/// As the standard says: `instance` is an instance, and the arrays have so many places.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetString(
    instance: Handle,
    references: *const ValueReference,
    count: usize,
    values: *mut Text,
    value_count: usize,
) -> Status {
    const NAME: &str = "fmi3GetString";
    // SAFETY: the importer gives null or an instance, and arrays of these sizes.
    unsafe {
        match count == value_count {
            true => get_texts(instance, NAME, (references, count), values),
            false => lengths_differ(instance, NAME, [count, value_count]),
        }
    }
}

/// Sets texts. No unit has one that can be set, so it refuses all but an empty list.
///
/// # Safety
/// As the standard says: `instance` is an instance, and the arrays have so many elements.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetString(
    instance: Handle,
    references: *const ValueReference,
    count: usize,
    values: *const Text,
    value_count: usize,
) -> Status {
    const NAME: &str = "fmi3SetString";
    // SAFETY: the importer gives null or an instance, and arrays of these sizes.
    unsafe {
        match count == value_count {
            true => set_texts(instance, NAME, (references, count), values),
            false => lengths_differ(instance, NAME, [count, value_count]),
        }
    }
}
