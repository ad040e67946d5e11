//! The report of `hitch loop`: settings, worst cases, step responses, and traces of moves.
pub mod course;
mod steps;
pub mod worst;

use hitch_plant::Model;
use maud::{Markup, html};

use super::page;
use crate::closed_loop::show::{HEADER, row, summed_up};
use crate::closed_loop::{LoopRun, MoveResult};

/// A closed-loop run with its settings.
#[derive(Debug, Clone, Copy)]
pub struct Shown<'a> {
    /// The plant.
    pub model: &'a Model,
    /// Source of the calibration.
    pub calibration: &'a str,
    /// Settings from the command line, as `group.key=value`.
    pub settings: &'a [String],
    /// The moves.
    pub run: &'a LoopRun,
}

/// The whole page.
#[must_use]
pub fn page(shown: &Shown) -> String {
    page::page("Closed loop", &sections(shown))
}

fn sections(shown: &Shown) -> Markup {
    let run = shown.run;
    html! {
        h1 { "Closed loop on " (shown.model.name) }
        p { "Calibration: " (shown.calibration)
            @if !shown.settings.is_empty() { ", with " (settings(shown.settings)) } "."
        }
        p.lead { (summed_up(&run.summary)) }
        (worst::section(&run.results))
        (steps::section(run))
        (course::section(run))
        h2 { "Figures of every move" }
        (page::table(&HEADER, run.results.iter().map(row)))
    }
}

/// Settings from the command line.
pub fn settings(settings: &[String]) -> Markup {
    html! { @for (i, setting) in settings.iter().enumerate() {
        @if i > 0 { ", " } code { (setting) }
    } }
}

/// Values of a quantity in order of first occurrence.
fn occurring<T: PartialEq>(results: &[MoveResult], of: impl Fn(&MoveResult) -> T) -> Vec<T> {
    let mut values = Vec::new();
    for value in results.iter().map(of) {
        if !values.contains(&value) {
            values.push(value);
        }
    }
    values
}
