//! Result of `hitch tune`.

use std::fmt;
use std::ops::ControlFlow;

use hitch_plant::Model;
use hitch_quantities::ValidCalibration;
use schemars::JsonSchema;
use serde::Serialize;

use hitch_output::error::Error;
use hitch_output::progress::Progress;
use hitch_output::text::Table;
use hitch_results::tuning::Change;
use hitch_results::tuning::figures::{self, Figure, Figures};

/// Result of `hitch tune`.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Tuned {
    /// The values that the search changed.
    pub changes: Vec<Change>,
    /// Figures of the initial calibration.
    pub before: Figures,
    /// Figures of the tuned calibration.
    pub after: Figures,
    /// The figures that have names in the text, with their limits.
    pub figures: Vec<Figure>,
}

/// What is searched from.
#[derive(Debug, Clone, Copy)]
pub struct Search<'a> {
    /// The plant.
    pub model: &'a Model,
    /// The initial calibration.
    pub base: &'a ValidCalibration,
    /// Names of the values that are not changed.
    pub fixed: &'a [String],
    /// Largest number of candidates.
    pub trials: usize,
}

impl Search<'_> {
    /// A search with its progress on the terminal.
    pub fn told<T>(
        &self,
        search: impl FnOnce(&(dyn Fn(usize, f64) -> ControlFlow<()> + Sync)) -> T,
    ) -> T {
        let progress = Progress::of(self.trials, "trying candidates");
        search(&|count, cost| {
            progress.reach(count, format!("best cost {cost:.3}"));
            ControlFlow::Continue(())
        })
    }

    /// No candidate was valid.
    pub fn nothing() -> Error {
        Error::Failed("the search found no valid calibration".to_owned())
    }
}

/// The result of a search.
#[derive(Debug)]
pub struct Found {
    /// The tuned calibration.
    pub calibration: ValidCalibration,
    /// Its document.
    pub tuned: Tuned,
    /// Its report; empty if none was asked for.
    pub page: String,
}

impl Tuned {
    /// Whether the tuned calibration is worse than the initial one.
    pub fn is_worse(&self) -> bool {
        self.after.cost > self.before.cost
    }
}

impl fmt::Display for Tuned {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let values = Table::of(Change::HEADINGS, self.changes.iter().map(Change::cells));
        let table = Table::of(Figure::HEADINGS, self.figures.iter().map(Figure::cells));
        let said = figures::sentence(&self.figures).unwrap_or_default();
        writeln!(f, "{values}\n{table}\n{said}")
    }
}
