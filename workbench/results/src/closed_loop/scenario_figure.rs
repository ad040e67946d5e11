//! A figure of a scenario, with its requirement.

use schemars::JsonSchema;
use serde::Serialize;

/// A figure of a scenario.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ScenarioFigure {
    /// What it is.
    pub name: String,
    /// Its value.
    pub value: f64,
    /// Its unit; empty for a ratio.
    pub unit: &'static str,
    /// The largest value that meets the requirement, if there is one.
    pub required: Option<f64>,
}

impl ScenarioFigure {
    /// A figure; `required` is the largest value that meets the requirement.
    #[must_use]
    pub fn new(name: &str, value: f64, unit: &'static str, required: Option<f64>) -> Self {
        Self {
            name: name.to_owned(),
            value,
            unit,
            required,
        }
    }

    /// Whether it meets its requirement.
    #[must_use]
    pub fn is_met(&self) -> bool {
        self.required.is_none_or(|required| self.value <= required)
    }
}
