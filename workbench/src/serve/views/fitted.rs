//! The constants of the first model: which can be held in a fit, and the fit, if there was one.

use hitch_identification::constants::tolerances::names;
use schemars::JsonSchema;
use serde::Serialize;

use crate::base_model::fit::{ShownBaseFit, ShownConstant};
use crate::serve::source::Subject;

/// The constants of the first model.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Constants {
    /// Names of those that a fit can hold.
    pub names: Vec<String>,
    /// The fit.
    pub fitted: Option<FittedConstants>,
}

/// Constants that were fitted.
#[derive(Debug, Serialize, JsonSchema)]
pub struct FittedConstants {
    /// Error of the declared model, sigma.
    pub error_before: f64,
    /// Error of the fitted model, sigma.
    pub error_after: f64,
    /// Headings of the table.
    pub headings: Vec<&'static str>,
    /// Its rows.
    pub rows: Vec<FittedRow>,
    /// Constants that the campaign does not determine.
    pub not_determined: Vec<String>,
    /// Constants at the end of their allowed deviation.
    pub at_an_end: Vec<String>,
}

/// A fitted constant.
#[derive(Debug, Serialize, JsonSchema)]
pub struct FittedRow {
    /// Cells as text.
    pub cells: Vec<String>,
    /// Whether it moved further than its tolerance.
    pub beyond: bool,
}

impl Constants {
    /// The constants of a first model.
    pub fn of(subject: &Subject) -> Self {
        Self {
            names: names(subject.model.constants()),
            fitted: subject.fitted.as_ref().map(FittedConstants::of),
        }
    }
}

impl FittedConstants {
    fn of(fit: &ShownBaseFit) -> Self {
        let determined = fit.constants.iter().filter(|one| one.determined);
        let row = |constant: &ShownConstant| FittedRow {
            cells: constant.cells().to_vec(),
            beyond: constant.is_beyond(),
        };
        Self {
            error_before: fit.error_before,
            error_after: fit.error_after,
            headings: ShownConstant::HEADINGS.to_vec(),
            rows: determined.map(row).collect(),
            not_determined: fit.not_determined.clone(),
            at_an_end: fit.at_an_end.clone(),
        }
    }
}
