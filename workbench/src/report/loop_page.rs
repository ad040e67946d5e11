//! The report of `hitch loop`: figures, and the course of every move.
use hitch_model::Model;
use maud::{Markup, html};

use super::chart::{Chart, Line, Stroke, legend};
use super::page;
use crate::closed_loop::{LoopRun, MoveResult, MoveTrace, Sample};
use crate::commands::loop_::{HEADER, name, row, summed_up};

/// What is shown after arrival, s.
const AFTER_S: f64 = 0.6;

/// The whole page.
#[must_use]
pub fn page(model: &Model, run: &LoopRun) -> String {
    page::page("Closed loop", &sections(model, run))
}

/// The page's content, for pages that hold more.
#[must_use]
pub fn sections(model: &Model, run: &LoopRun) -> Markup {
    let rows: Vec<Vec<String>> = run
        .results
        .iter()
        .map(|result| row(result).to_vec())
        .collect();
    html! {
        h1 { "Closed loop on " (model.name) }
        p { (summed_up(&run.summary)) }
        (page::table(&HEADER, &rows))
        h2 { "Every move" }
        (legend(&[(Stroke::Measured, "set point, lift coil"), (Stroke::After, "hitch, lowering coil")]))
        @for (result, trace) in run.results.iter().zip(&run.traces) { (course(result, trace)) }
    }
}

/// Angle, currents and pressure of one move.
fn course(result: &MoveResult, trace: &MoveTrace) -> Markup {
    let end_s = result.time_s + AFTER_S;
    let shown: Vec<&Sample> = trace
        .samples
        .iter()
        .filter(|sample| sample.time_s <= end_s)
        .collect();
    let column = |value: fn(&Sample) -> f64| {
        shown
            .iter()
            .map(|sample| value(sample))
            .collect::<Vec<f64>>()
    };
    let time = column(|sample| sample.time_s);
    let (lever, angle) = (
        column(|sample| sample.lever_deg),
        column(|sample| sample.angle_deg),
    );
    let lift = column(|sample| f64::from(sample.outputs.lift_current.0) * 1e-3);
    let lower = column(|sample| f64::from(sample.outputs.lower_current.0) * 1e-3);
    let pressure = column(|sample| sample.cylinder_pressure_bar);
    let chart = |caption: &str, y_title, lines: &[(&'static str, Stroke, &[f64])]| {
        let lines = lines
            .iter()
            .map(|&(name, stroke, y)| Line {
                name,
                stroke,
                x: &time,
                y,
            })
            .collect();
        Chart {
            caption: caption.to_owned(),
            x_title: "time, s",
            y_title,
            lines,
        }
        .figure()
    };
    html! {
        h3 { (name(result)) " degrees, " (format!("{:.0}", result.load_kg)) " kg" }
        (chart("Rocker angle", "angle, deg", &[("set point", Stroke::Measured, &lever), ("hitch", Stroke::After, &angle)]))
        (chart("Coil currents", "current, A", &[("lift", Stroke::Measured, &lift), ("lower", Stroke::After, &lower)]))
        (chart("Cylinder pressure", "pressure, bar", &[("cylinder", Stroke::After, &pressure)]))
    }
}
