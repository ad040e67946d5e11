//! A changed value of a calibration.

use schemars::JsonSchema;
use serde::Serialize;

/// One value that was searched.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Change {
    /// Group and key of the calibration file, without the unit: `group.key`.
    pub key: String,
    /// Value before, in the unit of the calibration file.
    pub before: f64,
    /// Value after, in the unit of the calibration file.
    pub after: f64,
}
