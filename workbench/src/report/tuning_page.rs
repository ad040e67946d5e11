//! The report of `hitch tune`: values and figures before and after, and both calibrations in closed loop.

use hitch_plant::Model;
use maud::{Markup, html};

use super::loop_page::{course, worst};
use super::page;
use super::two_runs::compared;
use crate::closed_loop::LoopRun;
use crate::text::known;
use crate::tuning::Change;

/// A tuned calibration.
#[derive(Debug, Clone, Copy)]
pub struct Shown<'a> {
    /// The plant.
    pub model: &'a Model,
    /// The changed values.
    pub changes: &'a [Change],
    /// Name, limit, value before and after of each figure of the search, as text.
    pub figures: &'a [[String; 4]],
    /// Moves with the initial calibration.
    pub before: &'a LoopRun,
    /// The same moves with the tuned one.
    pub after: &'a LoopRun,
}

/// The report as one HTML document.
#[must_use]
pub fn page(shown: &Shown) -> String {
    let title = format!("Calibration tuned for {}", shown.model.name);
    let content = html! { h1 { (title) } (sections(shown)) };
    page::page(&title, &content)
}

fn sections(shown: &Shown) -> Markup {
    let (before, after) = (shown.before, shown.after);
    let pair = |old: f64, new: f64| format!("{} → {}", known(old, 2), known(new, 2));
    let moves = course::shown(&after.results);
    let figures: Vec<Vec<String>> = shown.figures.iter().map(|row| row.to_vec()).collect();
    let change = |change: &Change| {
        let values = [change.before, change.after].map(|value| format!("{value:.3}"));
        [change.key.clone()].into_iter().chain(values).collect()
    };
    let changes: Vec<Vec<String>> = shown.changes.iter().map(change).collect();
    html! {
        p.lead {
            "Time over the shortest time, median: "
            strong { (pair(before.summary.ratio_median, after.summary.ratio_median)) }
            ". Largest overshoot: "
            strong { (pair(before.summary.overshoot_max_deg, after.summary.overshoot_max_deg)) } " deg."
        }
        h2 { @if moves.len() == after.results.len() { "Every move" } @else { "The worst moves" } " with both calibrations" }
        p { "The headings have the figures of the tuned calibration." }
        @for index in moves {
            h3 { (course::heading(&after.results[index])) }
            (compared(before, after, index, ["before", "after"]))
        }
        (worst::section(&after.results))
        h2 { "Changed values" }
        (page::table(&["value", "before", "after"], &changes))
        h2 { "Figures of the search" }
        p { "On the plant and its neighbours, with typical effects where the model has none." }
        (page::table(&["figure", "limit", "before", "after"], &figures))
    }
}
