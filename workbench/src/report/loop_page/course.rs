//! Traces of angle, currents and pressures: of all moves if they are few, else of the worst.
use maud::{Markup, html};

use crate::closed_loop::show::name;
use crate::closed_loop::{LoopRun, MoveResult, MoveTrace, Sample};
use crate::report::chart::{Chart, Line, Stroke, legend};
use crate::text::known;

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
        (legend(&[(Stroke::Measured, "set point, pump"), (Stroke::After, "hitch, lift coil, cylinder"), (Stroke::Before, "lowering coil")]))
        @for index in shown { (course(&run.results[index], &run.traces[index])) }
    }
}

fn shown(results: &[MoveResult]) -> Vec<usize> {
    if results.len() <= MOST {
        return (0..results.len()).collect();
    }
    let figures: [fn(&MoveResult) -> f64; 4] = [
        |result| result.ratio,
        |result| result.overshoot_deg,
        |result| result.final_error_deg,
        |result| result.pressure_swing_ratio,
    ];
    let mut chosen = Vec::new();
    for figure in figures {
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
    let column = |value: fn(&Sample) -> f64| -> Vec<f64> {
        let samples = trace.samples.iter();
        samples
            .take_while(|sample| sample.time_s <= end_s)
            .map(value)
            .collect()
    };
    let time = column(|sample| sample.time_s);
    let chart = |caption: &str, y_title, lines: [(&'static str, Stroke, Vec<f64>); 2]| {
        let lines = lines.iter().map(|(name, stroke, y)| Line {
            name,
            stroke: *stroke,
            x: &time,
            y,
        });
        Chart {
            caption: caption.to_owned(),
            x_title: "time, s",
            y_title,
            lines: lines.collect(),
        }
        .figure()
    };
    let angles = [
        (
            "set point",
            Stroke::Measured,
            column(|sample| sample.lever_deg),
        ),
        ("hitch", Stroke::After, column(|sample| sample.angle_deg)),
    ];
    let currents = [
        (
            "lift",
            Stroke::After,
            column(|sample| f64::from(sample.outputs.lift_current.0) * 1e-3),
        ),
        (
            "lower",
            Stroke::Before,
            column(|sample| f64::from(sample.outputs.lower_current.0) * 1e-3),
        ),
    ];
    let pressures = [
        (
            "pump",
            Stroke::Measured,
            column(|sample| sample.pump_pressure_bar),
        ),
        (
            "cylinder",
            Stroke::After,
            column(|sample| sample.cylinder_pressure_bar),
        ),
    ];
    html! {
        h3 { (name(result)) " degrees, " (format!("{:.0} kg, {:.0} °C", result.load_kg, result.oil_temperature_c))
            ": ratio " (known(result.ratio, 2)) ", overshoot " (format!("{:.2}", result.overshoot_deg)) " deg" }
        div.grid {
            (chart("Rocker angle", "angle, deg", angles))
            (chart("Coil currents", "current, A", currents))
            (chart("Pressures of pump and cylinder", "pressure, bar", pressures))
        }
    }
}
