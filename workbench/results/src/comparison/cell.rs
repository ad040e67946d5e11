//! A cell of the error map.

use schemars::JsonSchema;
use serde::Serialize;

use super::groups::Grouping;

/// Error of one channel in one part of the data.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Cell {
    /// Grouping of the samples.
    pub by: Grouping,
    /// Name of the group.
    pub part: String,
    /// Key of the channel.
    pub channel: &'static str,
    /// Root mean square in sigma.
    pub error: f64,
    /// Mean in sigma; positive where the measurement exceeds the model.
    pub bias: f64,
    /// Compared samples.
    pub samples: usize,
}
