//! The report of `hitch tune`: values and figures before and after, and both calibrations in closed loop.

use hitch_plant::Model;
use maud::{Markup, html};

use super::loop_page::{course, worst};
use super::page;
use super::same_move::compared;
use super::variants_page::every_press;
use crate::closed_loop::{LoopRun, PressRun};
use crate::tuning::Change;
use crate::tuning::figures::{self, Figure};
use hitch_output::text::known;

/// A tuned calibration.
#[derive(Debug, Clone, Copy)]
pub struct Shown<'a> {
    /// The plant.
    pub model: &'a Model,
    /// The changed values.
    pub changes: &'a [Change],
    /// Figures of the search.
    pub figures: &'a [Figure],
    /// Moves with the initial calibration, and with the tuned one; `None` without moves.
    pub moves: Option<[&'a LoopRun; 2]>,
    /// Presses of the button with both; `None` without presses.
    pub presses: Option<[&'a PressRun; 2]>,
}

/// The report as one HTML document.
#[must_use]
pub fn page(shown: &Shown) -> String {
    let title = format!("Calibration tuned for {}", shown.model.name);
    let content = html! { h1 { (title) } (sections(shown)) };
    page::page(&title, &content)
}

fn sections(shown: &Shown) -> Markup {
    html! {
        (lead(shown))
        @if let Some([before, after]) = shown.moves { (moves(before, after)) }
        @if let Some([before, after]) = shown.presses {
            (every_press(&[("before", before), ("after", after)]))
        }
        h2 { "Changed values" }
        (page::table(&Change::HEADINGS, shown.changes.iter().map(Change::cells)))
        h2 { "Figures of the search" }
        p { "On the plant and its neighbours, with typical effects where the model has none. "
            @if let Some(said) = figures::sentence(shown.figures) { strong { (said) } } }
        (page::table(&Figure::HEADINGS, shown.figures.iter().map(Figure::cells)))
    }
}

fn lead(shown: &Shown) -> Markup {
    let pair =
        |old: f64, new: f64, digits| format!("{} → {}", known(old, digits), known(new, digits));
    html! {
        @if let Some([before, after]) = shown.moves { p.lead {
            "Time over the shortest time, median: "
            strong { (pair(before.summary.ratio_median, after.summary.ratio_median, 2)) }
            ". Largest overshoot: "
            strong { (pair(before.summary.overshoot_max_deg, after.summary.overshoot_max_deg, 2)) } " deg."
        } }
        @if let Some([before, after]) = shown.presses.map(|both| both.map(|run| run.summary)) { p.lead {
            "Button: largest overshoot of the speed: "
            strong { (pair(100.0 * before.speed_overshoot_max, 100.0 * after.speed_overshoot_max, 1)) }
            " %. Latest start: " strong { (pair(before.start_delay_max_s, after.start_delay_max_s, 3)) } " s."
        } }
    }
}

fn moves(before: &LoopRun, after: &LoopRun) -> Markup {
    let moves = course::shown(&after.results);
    html! {
        h2 { @if moves.len() == after.results.len() { "Every move" } @else { "The worst moves" } " with both calibrations" }
        p { "The headings have the figures of the tuned calibration." }
        @for index in moves {
            h3 { (course::heading(&after.results[index])) }
            (compared(&[("before", before), ("after", after)], index))
        }
        (worst::section(&after.results))
    }
}
