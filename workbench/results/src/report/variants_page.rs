//! The report of `hitch loop` with several calibrations, and that of rate control.

use std::path::Path;

use hitch_plant::Model;
use maud::{Markup, html};

use super::loop_page::{course, settings};
use super::page;
use super::same_move::{compared, pressed};
use crate::closed_loop::show_variants::{self, Named, Sides};
use crate::closed_loop::variant::Variant;
use crate::closed_loop::{LoopRun, PressResult, PressRun};
use hitch_output::text::{joined, known};

/// What was driven.
#[derive(Debug, Clone, Copy)]
pub struct Setup<'a> {
    /// The plant.
    pub model: &'a Model,
    /// File of the calibration; `None` for the nominal one.
    pub calibration: Option<&'a Path>,
    /// Settings from the command line, as `group.key=value`.
    pub settings: &'a [String],
    /// The variants; the first run has the calibration without them.
    pub variants: &'a [Variant],
}

/// The report of moves, as one HTML document.
#[must_use]
pub fn of_moves(setup: &Setup<'_>, runs: Named<'_, LoopRun>) -> String {
    let results = runs.first().map_or(&[][..], |(_, run)| &run.results);
    let shown = course::shown(results);
    let content = html! {
        (head(setup))
        (sides(&show_variants::figures(runs)))
        h2 { @if shown.len() == results.len() { "Every move" } @else { "The worst moves of the first calibration" } }
        @for index in shown {
            h3 { (course::conditions(&results[index])) }
            (compared(runs, index))
        }
        h2 { "Moves side by side" }
        p { (show_variants::MOVE_CELLS) }
        (sides(&show_variants::moves(runs)))
    };
    page::page("Closed loop", &content)
}

/// The report of presses of the button, as one HTML document.
#[must_use]
pub fn of_presses(setup: &Setup<'_>, runs: Named<'_, PressRun>) -> String {
    let content = html! {
        (head(setup))
        (sides(&show_variants::press_figures(runs)))
        (every_press(runs))
        h2 { "Presses side by side" }
        p { (show_variants::PRESS_CELLS) }
        (sides(&show_variants::presses(runs)))
    };
    page::page("Rate control", &content)
}

/// Speed and angle in every press, with each calibration.
pub fn every_press(runs: Named<'_, PressRun>) -> Markup {
    let results = runs.first().map_or(&[][..], |(_, run)| &run.results);
    html! {
        h2 { "Every press of the button" }
        @for index in 0..results.len() {
            h3 { (press_heading(runs, index)) }
            (pressed(runs, index))
        }
    }
}

fn press_heading(runs: Named<'_, PressRun>, index: usize) -> String {
    let all: Vec<&PressResult> = runs.iter().map(|(_, run)| &run.results[index]).collect();
    let overshoots = all.iter();
    let overshoots = overshoots.map(|press| known(100.0 * press.speed_overshoot, 0));
    let conditions = all.first().map_or_else(String::new, |press| {
        format!(
            "{:+.1} deg/s, {:.0} kg, {:.0} °C",
            press.rate_deg_per_s, press.load_kg, press.oil_temperature_c
        )
    });
    format!("{conditions}: overshoot {} %", joined(overshoots, " → "))
}

fn head(setup: &Setup<'_>) -> Markup {
    html! {
        h1 { "Closed loop on " (setup.model.name) }
        p { "Calibration: " (setup.calibration.map_or_else(|| "nominal".to_owned(), |path| path.display().to_string()))
            @if !setup.settings.is_empty() { ", with " (settings(setup.settings)) } "."
        }
        @for variant in setup.variants {
            p { strong { (variant.name) } ": " (settings(&variant.settings)) }
        }
    }
}

fn sides(sides: &Sides) -> Markup {
    let header: Vec<&str> = sides.header.iter().map(String::as_str).collect();
    page::table(&header, &sides.rows)
}
