//! Figures of a tuned calibration beside those of the initial one, and whether each is within its limit.

use hitch_quantities::ValidCalibration;
use schemars::JsonSchema;
use serde::Serialize;

use crate::closed_loop::{PressSummary, ScenarioFigure, Summary};
use hitch_output::text::known;

/// Figures of a calibration on the plant and its neighbours.
#[derive(Debug, Clone, Copy, Default, Serialize, JsonSchema)]
pub struct Figures {
    /// Cost, the objective of the search; a smaller one is better.
    pub cost: f64,
    /// Figures of all moves; absent without moves.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub summary: Option<Summary>,
    /// Figures of all presses of the button; absent without presses.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub presses: Option<PressSummary>,
}

/// A calibration with its figures.
#[derive(Debug, Clone)]
pub struct Judged {
    /// The calibration.
    pub calibration: ValidCalibration,
    /// Its cost, with the figures of moves and presses.
    pub figures: Figures,
    /// The figures that have names in the text, with their limits.
    pub named: Vec<ScenarioFigure>,
}

impl Judged {
    /// The figures of this initial calibration beside those of a tuned one.
    #[must_use]
    pub fn compared(&self, after: &Self) -> Vec<Figure> {
        let figure = |(before, after): (&ScenarioFigure, &ScenarioFigure)| {
            let unit = if before.unit.is_empty() { "" } else { ", " };
            let name = format!("{}{unit}{}", before.name, before.unit);
            Figure::new(name, before.required, before.value, after.value)
        };
        let cost = Figure::new("cost", None, self.figures.cost, after.figures.cost);
        let pairs = self.named.iter().zip(&after.named);
        pairs.map(figure).chain([cost]).collect()
    }
}

/// A figure of both calibrations.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Figure {
    /// Name, with its unit.
    pub name: String,
    /// The largest value that is wanted; `null` without one.
    pub limit: Option<f64>,
    /// Value of the initial calibration.
    pub before: f64,
    /// Value of the tuned calibration.
    pub after: f64,
    /// Whether the tuned calibration is within the limit; `null` without one.
    pub met: Option<bool>,
}

impl Figure {
    /// Column headings of [`Figure::cells`].
    pub const HEADINGS: [&'static str; 5] = ["figure", "limit", "before", "after", ""];

    /// A figure; `limit` is the largest value that is wanted.
    #[must_use]
    pub fn new(name: impl Into<String>, limit: Option<f64>, before: f64, after: f64) -> Self {
        Self {
            name: name.into(),
            limit,
            before,
            after,
            met: limit.map(|limit| after <= limit),
        }
    }

    /// Whether the limit is met, in words; empty without a limit.
    #[must_use]
    pub fn verdict(&self) -> &'static str {
        match self.met {
            Some(true) => "limit met",
            Some(false) => "limit not met",
            None => "",
        }
    }

    /// Its row in a table.
    #[must_use]
    pub fn cells(&self) -> [String; 5] {
        [
            self.name.clone(),
            self.limit
                .map_or_else(String::new, |limit| format!("{limit:.2}")),
            known(self.before, 3),
            known(self.after, 3),
            self.verdict().to_owned(),
        ]
    }
}

/// The figures of moves and presses that have names in the text.
pub fn named(moves: Option<&Summary>, presses: Option<&PressSummary>) -> Vec<ScenarioFigure> {
    let moves = moves.into_iter().flat_map(of_moves);
    moves
        .chain(presses.into_iter().flat_map(of_presses))
        .collect()
}

/// How many limits are met, as a sentence; `None` without limits.
#[must_use]
pub fn sentence(figures: &[Figure]) -> Option<String> {
    let limited: Vec<&Figure> = figures.iter().filter(|one| one.met.is_some()).collect();
    let missed = limited.iter().filter(|one| one.met == Some(false));
    let missed: Vec<&str> = missed.map(|one| one.name.as_str()).collect();
    match (limited.len(), missed.is_empty()) {
        (0, _) => None,
        (_, true) => Some("All limits are met.".to_owned()),
        (all, false) => Some(format!(
            "{} of {all} limits are met. Not met: {}.",
            all - missed.len(),
            missed.join("; ")
        )),
    }
}

fn of_moves(all: &Summary) -> [ScenarioFigure; 6] {
    let of = |name: &str, unit, limit, value| ScenarioFigure::new(name, value, unit, Some(limit));
    [
        of("time ratio, median", "", 1.15, all.ratio_median),
        of("time ratio, 95 %", "", 1.4, all.ratio_p95),
        of("overshoot", "deg", 0.3, all.overshoot_max_deg),
        of("final error", "deg", 0.3, all.final_error_max_deg),
        of("pressure swing", "", 1.5, all.pressure_swing_ratio_max),
        of(
            "coil activations after arrival",
            "",
            0.0,
            f64::from(all.switched_on_after),
        ),
    ]
}

fn of_presses(all: &PressSummary) -> [ScenarioFigure; 4] {
    let of = |name: &str, unit, limit, value| {
        ScenarioFigure::new(&format!("button: {name}"), value, unit, limit)
    };
    [
        of(
            "error of the steady speed",
            "",
            Some(0.05),
            all.speed_error_max,
        ),
        of("overshoot of the speed", "", None, all.speed_overshoot_max),
        of("latest start", "s", None, all.start_delay_max_s),
        of("latest stop", "s", None, all.stop_delay_max_s),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_figure_above_its_limit_is_named() {
        let figures = [
            Figure::new("overshoot, deg", Some(0.3), 0.2, 0.3),
            Figure::new("final error, deg", Some(0.3), 0.2, 0.304),
            Figure::new("cost", None, 2.0, 1.0),
        ];
        let words: Vec<&str> = figures.iter().map(Figure::verdict).collect();
        assert_eq!(words, ["limit met", "limit not met", ""]);
        let said = sentence(&figures);
        assert_eq!(
            said.as_deref(),
            Some("1 of 2 limits are met. Not met: final error, deg.")
        );
        assert_eq!(
            sentence(&figures[..1]).as_deref(),
            Some("All limits are met.")
        );
        assert_eq!(sentence(&figures[2..]), None);
    }

    /// A figure that is not known is not within its limit.
    #[test]
    fn an_unknown_figure_is_not_within_its_limit() {
        assert_eq!(Figure::new("x", Some(1.0), 0.5, f64::NAN).met, Some(false));
    }
}
