//! A value with its interval.

use hitch_draft::fit::Estimated;
use schemars::JsonSchema;
use serde::Serialize;

/// A value with its 95 % interval.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub struct Interval {
    /// Mean.
    pub value: f64,
    /// Lower end of the 95 % interval.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

impl From<Estimated> for Interval {
    fn from(estimated: Estimated) -> Self {
        let [low, high] = estimated.interval();
        Self {
            value: estimated.mean,
            low,
            high,
        }
    }
}

impl Interval {
    /// The interval in another unit, or of a multiple.
    #[must_use]
    pub fn times(self, factor: f64) -> Self {
        Self {
            value: factor * self.value,
            low: factor * self.low,
            high: factor * self.high,
        }
    }
}
