//! The report of a scenario of the field: figures, and a course over time.

use hitch_closed_loop::Sample;
use hitch_field::tractor::Outputs;
use hitch_plant::Model;
use maud::{Markup, html};

use super::chart::{Chart, Stroke};
use super::drawn::drawn;
use super::page;
use crate::field_loop::scenario::FieldRun;
use crate::field_loop::show::{HEADER, row};

/// Steps between two drawn points.
const EVERY: usize = 20;

/// The whole page.
#[must_use]
pub fn page(scenario: &str, model: &Model, calibration: &str, run: &FieldRun) -> String {
    let content = html! {
        h1 { "Scenario " (scenario) " on " (model.name) }
        p { "Calibration: " (calibration) ", with pins, slip guard and ride damping fitted." }
        (page::table(&HEADER, run.figures.iter().map(row)))
        h2 { "Course" }
        (course(run))
    };
    page::page("Closed loop in the field", &content)
}

fn course(run: &FieldRun) -> Markup {
    let indices = || (0..run.hitch.len()).step_by(EVERY);
    let hitch = |name: &str, stroke, value: fn(&Sample) -> f64| {
        let sample = |index: usize| run.hitch.get(index).map(|at| (at.time_s, value(at)));
        (
            name.to_owned(),
            stroke,
            indices().filter_map(sample).unzip(),
        )
    };
    let field = |name: &str, value: fn(&Outputs) -> f64| {
        let sample =
            |index: usize| Some((run.hitch.get(index)?.time_s, value(run.field.get(index)?)));
        [(
            name.to_owned(),
            Stroke::After,
            indices().filter_map(sample).unzip(),
        )]
    };
    let target_deg = |sample: &Sample| f64::from(sample.outputs.target.0) * 1e-3;
    let angles = [
        hitch("set point", Stroke::Measured, target_deg),
        hitch("hitch", Stroke::After, |sample| sample.angle_deg),
    ];
    let mut charts = vec![Chart::over_time("Rocker angle", "angle, deg", angles)];
    if !run.field.is_empty() {
        let draft = field("draft", |field| field.draft_n * 1e-3);
        let depth = field("depth", |field| field.depth_m * 100.0);
        let slip = field("slip", |field| field.slip * 100.0);
        charts.extend([
            Chart::over_time("Draft", "draft, kN", draft),
            Chart::over_time("Depth", "depth, cm", depth),
            Chart::over_time("Slip", "slip, %", slip),
        ]);
    }
    let pressure = |sample: &Sample| sample.cylinder_pressure_bar;
    let pressure = [hitch("cylinder", Stroke::After, pressure)];
    let currents = [
        hitch("lift coil", Stroke::Lift, Sample::lift_current_a),
        hitch("lowering coil", Stroke::Lower, Sample::lower_current_a),
    ];
    charts.extend([
        Chart::over_time("Cylinder pressure", "pressure, bar", pressure),
        Chart::over_time("Coil currents", "current, A", currents),
    ]);
    drawn("Angle, field and coils over time", &charts)
}
