//! Constants of the base model that an explanation corrected.

use std::fmt;

use hitch_identification::explanation::constants::CorrectedConstants;
use hitch_identification::explanation::explain::Verdict;
use schemars::JsonSchema;
use serde::Serialize;

use crate::base_model::fit::{ShownConstant, ShownPoint};
use hitch_output::text::{Table, indented, wrapped};

/// Constants that differ from the declared ones, within the tolerances of data sheets.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Corrected {
    /// Error of the model with fitted constants and without further effects, in sigma.
    pub error_after: f64,
    /// The constants outside the flow curves.
    pub constants: Vec<ShownConstant>,
    /// The flow curves, point by point.
    pub curves: Vec<ShownPoint>,
    /// Why there are no intervals; `null` if there are.
    pub withheld: Option<String>,
}

impl Corrected {
    /// The display form. If the model leaves a lack of fit with all its effects, the constants take up errors of its
    /// structure, and their intervals are withheld.
    #[must_use]
    pub fn new(found: &CorrectedConstants, verdict: Verdict, error: f64) -> Self {
        let mut corrected = Self {
            error_after: found.fit.error(),
            constants: found.constants.iter().map(ShownConstant::new).collect(),
            curves: found.curves.iter().map(ShownPoint::new).collect(),
            withheld: None,
        };
        if verdict == Verdict::Unexplained {
            corrected.withheld = Some(format!(
                "The intervals are withheld: the model leaves {error:.2} sigma, so that its constants take up errors of \
                 its structure."
            ));
            for constant in &mut corrected.constants {
                (constant.low, constant.high) = (f64::NAN, f64::NAN);
            }
            for point in &mut corrected.curves {
                (point.low_lpm, point.high_lpm) = (f64::NAN, f64::NAN);
            }
        }
        corrected
    }

    /// The first sentence, with the error before.
    #[must_use]
    pub fn sentence(&self, error_before: f64) -> String {
        format!(
            "The declared constants are off. With constants fitted within the tolerances of data sheets the error is {:.2} \
             sigma instead of {error_before:.2}.",
            self.error_after
        )
    }

    /// The constants whose intervals do not contain their declared values.
    pub fn moved(&self) -> impl Iterator<Item = &ShownConstant> {
        let is_moved = |constant: &&ShownConstant| {
            constant.determined && !(constant.low..=constant.high).contains(&constant.declared)
        };
        self.constants.iter().filter(is_moved)
    }

    /// Each valve with the smallest and the largest change of its flow at the points that the campaign determines, as
    /// shares of the declared flow.
    #[must_use]
    pub fn flow_changes(&self) -> Vec<(&'static str, f64, f64)> {
        let mut changes: Vec<(&'static str, f64, f64)> = Vec::new();
        for point in self.curves.iter().filter(|point| point.determined) {
            let change = point.fitted_lpm / point.declared_lpm - 1.0;
            match changes.iter_mut().find(|(valve, ..)| *valve == point.valve) {
                Some((_, low, high)) => (*low, *high) = (low.min(change), high.max(change)),
                None => changes.push((point.valve, change, change)),
            }
        }
        changes
    }
}

impl fmt::Display for Corrected {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.moved().next().is_some() {
            let moved = self.moved().map(ShownConstant::cells);
            writeln!(f, "{}", Table::of(ShownConstant::HEADINGS, moved))?;
        }
        if let Some(reason) = &self.withheld {
            writeln!(f, "{}", wrapped(reason))?;
        }
        for (valve, low, high) in self.flow_changes() {
            let line = format!(
                "{valve}: flow {:+.1} to {:+.1} % of the declared curve",
                100.0 * low,
                100.0 * high
            );
            writeln!(f, "{}", indented(&line, 2))?;
        }
        let hint = "For intervals of each point, and to see the curves: hitch model fit, on a campaign of the machine in good order.";
        writeln!(f, "{}", wrapped(hint))
    }
}
