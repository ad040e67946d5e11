//! Traces of angle, currents and pressures: of all moves if they are few, else of the worst.
use maud::{Markup, html};

use super::worst::{FIGURES, Figure};
use crate::closed_loop::show::name;
use crate::closed_loop::{LoopRun, MoveResult, MoveTrace};
use crate::report::chart::{Chart, Stroke};
use crate::report::drawn::drawn;
use hitch_closed_loop::Sample;
use hitch_output::text::known;

/// Time shown after arrival, s.
const AFTER_S: f64 = 0.6;
/// Maximum number of moves for which all are shown.
const MOST: usize = 30;
/// Number of worst moves by each figure, if there are more.
const WORST: usize = 4;

/// The section.
pub fn section(run: &LoopRun) -> Markup {
    let shown = shown(&run.results);
    html! {
        h2 { @if shown.len() == run.results.len() { "Every move" } @else { "The worst moves" } }
        @if shown.len() < run.results.len() {
            p { "The " (WORST) " worst by time ratio, by overshoot, by final error and by pressure swing." }
        }
        @for index in shown { (course(&run.results[index], &run.traces[index])) }
    }
}

/// Indices of all moves if they are few, else of the worst.
pub fn shown(results: &[MoveResult]) -> Vec<usize> {
    if results.len() <= MOST {
        return (0..results.len()).collect();
    }
    let mut chosen = Vec::new();
    for Figure { of: figure, .. } in FIGURES {
        let mut order: Vec<usize> = (0..results.len()).collect();
        order.sort_by(|&a, &b| figure(&results[b]).total_cmp(&figure(&results[a])));
        chosen.extend(order.into_iter().take(WORST));
    }
    let mut seen = Vec::new();
    chosen.retain(|index| {
        let new = !seen.contains(index);
        seen.push(*index);
        new
    });
    chosen
}

fn course(result: &MoveResult, trace: &MoveTrace) -> Markup {
    let end_s = result.took_s() + AFTER_S;
    let line = |name: &str, stroke, value: fn(&Sample) -> f64| {
        (name.to_owned(), stroke, trace.points(end_s, value))
    };
    let angles = [
        line("set point", Stroke::Measured, |sample| sample.lever_deg),
        line("hitch", Stroke::After, |sample| sample.angle_deg),
    ];
    let currents = [
        line("lift coil", Stroke::Lift, Sample::lift_current_a),
        line("lowering coil", Stroke::Lower, Sample::lower_current_a),
    ];
    let pressures = [
        line("pump", Stroke::Pump, |sample| sample.pump_pressure_bar),
        line("cylinder", Stroke::After, |sample| {
            sample.cylinder_pressure_bar
        }),
    ];
    let charts = [
        Chart::over_time("Rocker angle", "angle, deg", angles),
        Chart::over_time("Coil currents", "current, A", currents),
        Chart::over_time("Pressures of pump and cylinder", "pressure, bar", pressures),
    ];
    let label = format!("Angle, currents and pressures over time, {}", name(result));
    html! {
        h3 { (heading(result)) }
        (drawn(&label, &charts))
    }
}

/// The move with its figures.
pub fn heading(result: &MoveResult) -> String {
    format!(
        "{}: ratio {}, overshoot {:.2} deg",
        conditions(result),
        known(result.ratio, 2),
        result.overshoot_deg
    )
}

/// The move with its load and oil temperature.
pub fn conditions(result: &MoveResult) -> String {
    format!(
        "{} degrees, {:.0} kg, {:.0} °C",
        name(result),
        result.load_kg,
        result.oil_temperature_c
    )
}
