//! The report of a scenario of the field: figures, and a course over time.

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
    let times = |index: usize| run.hitch.get(index).map_or(0.0, |sample| sample.time_s);
    let indices = || (0..run.hitch.len()).step_by(EVERY);
    let hitch = |name: &str, stroke, value: &dyn Fn(&hitch_closed_loop::Sample) -> f64| {
        let points =
            indices().filter_map(|index| Some((times(index), value(run.hitch.get(index)?))));
        (name.to_owned(), stroke, points.unzip())
    };
    let field = |name: &str, value: &dyn Fn(&hitch_field::tractor::Outputs) -> f64| {
        let points =
            indices().filter_map(|index| Some((times(index), value(run.field.get(index)?))));
        (name.to_owned(), Stroke::After, points.unzip())
    };
    let chart = |caption: &str, y_title, lines| Chart {
        caption: caption.to_owned(),
        axes: ["time, s", y_title],
        lines,
    };
    let mut charts = vec![chart(
        "Rocker angle",
        "angle, deg",
        vec![
            hitch("set point", Stroke::Measured, &|sample| {
                f64::from(sample.outputs.target.0) * 1e-3
            }),
            hitch("hitch", Stroke::After, &|sample| sample.angle_deg),
        ],
    )];
    if !run.field.is_empty() {
        charts.extend([
            chart(
                "Draft",
                "draft, kN",
                vec![field("draft", &|field| field.draft_n * 1e-3)],
            ),
            chart(
                "Depth",
                "depth, cm",
                vec![field("depth", &|field| field.depth_m * 100.0)],
            ),
            chart(
                "Slip",
                "slip, %",
                vec![field("slip", &|field| field.slip * 100.0)],
            ),
        ]);
    }
    charts.extend([
        chart(
            "Cylinder pressure",
            "pressure, bar",
            vec![hitch("cylinder", Stroke::After, &|sample| {
                sample.cylinder_pressure_bar
            })],
        ),
        chart(
            "Coil currents",
            "current, A",
            vec![
                hitch("lift coil", Stroke::Lift, &|sample| {
                    f64::from(sample.outputs.lift_current.0) * 1e-3
                }),
                hitch("lowering coil", Stroke::Lower, &|sample| {
                    f64::from(sample.outputs.lower_current.0) * 1e-3
                }),
            ],
        ),
    ]);
    drawn("Angle, field and coils over time", &charts)
}
