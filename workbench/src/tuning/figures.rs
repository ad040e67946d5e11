//! Figures of a tuned calibration beside those of the initial one, and whether each is within its limit.

use schemars::JsonSchema;
use serde::Serialize;

use crate::closed_loop::{PressSummary, Summary};
use crate::text::known;

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

/// The figures of moves, presses and cost, each of the initial and of the tuned calibration.
#[must_use]
pub fn compared(
    moves: Option<[&Summary; 2]>,
    presses: Option<[&PressSummary; 2]>,
    cost: [f64; 2],
) -> Vec<Figure> {
    let mut figures = Vec::new();
    figures.extend(moves.into_iter().flat_map(of_moves));
    figures.extend(presses.into_iter().flat_map(of_presses));
    figures.push(Figure::new("cost", None, cost[0], cost[1]));
    figures
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

fn of_moves([before, after]: [&Summary; 2]) -> [Figure; 6] {
    let of = |name: &str, limit: f64, value: fn(&Summary) -> f64| {
        Figure::new(name, Some(limit), value(before), value(after))
    };
    [
        of("time ratio, median", 1.15, |all| all.ratio_median),
        of("time ratio, 95 %", 1.4, |all| all.ratio_p95),
        of("overshoot, deg", 0.3, |all| all.overshoot_max_deg),
        of("final error, deg", 0.3, |all| all.final_error_max_deg),
        of("pressure swing", 1.5, |all| all.pressure_swing_ratio_max),
        of("coil activations after arrival", 0.0, |all| {
            f64::from(all.switched_on_after)
        }),
    ]
}

fn of_presses([before, after]: [&PressSummary; 2]) -> [Figure; 4] {
    let of = |name: &str, limit: Option<f64>, value: fn(&PressSummary) -> f64| {
        Figure::new(name, limit, value(before), value(after))
    };
    [
        of("button: error of the steady speed", Some(0.05), |all| {
            all.speed_error_max
        }),
        of("button: overshoot of the speed", None, |all| {
            all.speed_overshoot_max
        }),
        of("button: latest start, s", None, |all| all.start_delay_max_s),
        of("button: latest stop, s", None, |all| all.stop_delay_max_s),
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
