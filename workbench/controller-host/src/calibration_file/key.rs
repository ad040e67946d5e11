//! The key of a scalar.

use hitch_quantities::calibration::parameter::ParameterInfo;

/// Checks the value of a scalar: counts are integers, physical quantities are rounded.
pub fn is_exact(info: &ParameterInfo, value: f64) -> bool {
    info.suffix != "count" || value.fract() == 0.0
}

/// Key of a scalar in a file: its name with the engineering unit as suffix.
#[must_use]
pub fn key(info: &ParameterInfo) -> String {
    format!("{}_{}", info.name, info.suffix)
}
