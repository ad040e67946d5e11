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

impl Change {
    /// Column headings of [`Change::cells`].
    pub const HEADINGS: [&'static str; 3] = ["value", "before", "after"];

    /// Its row in a table.
    #[must_use]
    pub fn cells(&self) -> [String; 3] {
        let [before, after] = [self.before, self.after].map(|value| format!("{value:.3}"));
        [self.key.clone(), before, after]
    }
}
