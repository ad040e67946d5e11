//! A tuned calibration.

use schemars::JsonSchema;
use serde::Serialize;

use crate::tuned::TunedFor;
use hitch_results::tuning::Change;
use hitch_results::tuning::figures::{Figure, sentence};

/// A tuned calibration: its figures and its changed values.
#[derive(Debug, Serialize, JsonSchema)]
pub struct TunedCalibration {
    /// How many limits are met; `null` without limits.
    pub sentence: Option<String>,
    /// Headings of the table of figures.
    pub headings: Vec<&'static str>,
    /// The figures.
    pub figures: Vec<FigureRow>,
    /// The changed values.
    pub changes: Vec<Change>,
}

/// A figure of both calibrations.
#[derive(Debug, Serialize, JsonSchema)]
pub struct FigureRow {
    /// Cells as text.
    pub cells: Vec<String>,
    /// Whether its limit is met; `null` without one.
    pub met: Option<bool>,
}

impl TunedCalibration {
    /// The view of a tuned calibration.
    pub fn of(tuned: &TunedFor) -> Self {
        let row = |figure: &Figure| FigureRow {
            cells: figure.cells().to_vec(),
            met: figure.met,
        };
        Self {
            sentence: sentence(&tuned.figures),
            headings: Figure::HEADINGS.to_vec(),
            figures: tuned.figures.iter().map(row).collect(),
            changes: tuned.changes.clone(),
        }
    }
}
