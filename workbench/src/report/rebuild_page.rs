//! Report sections: the rebuilt valve map, and the closed loop with it.

use hitch_quantities::calibration::valve_table::ValveTable;
use maud::{Markup, html};

use super::chart::{Chart, Line, Stroke, legend};
use super::page;
use crate::closed_loop::{LoopRun, Sample};
use crate::rebuild::Rebuild;
use crate::text::known;

/// Time shown after the later arrival, s.
const AFTER_S: f64 = 0.5;
/// Conversion from microlitres per second to litres per minute.
const LPM_PER_UL_S: f64 = 60e-6;

/// The sections.
pub fn sections(rebuild: &Rebuild) -> Markup {
    html! {
        h2 { "Rebuilt valve map" }
        p { "Coil current over flow: from the data sheet (nominal), and from the identified model (rebuilt)." }
        (legend(&[(Stroke::Before, "nominal"), (Stroke::After, "rebuilt")]))
        div.grid {
            (map("Lift valve", &rebuild.nominal.lift, &rebuild.rebuilt.lift))
            (map("Lowering valve", &rebuild.nominal.lower, &rebuild.rebuilt.lower))
        }
        h2 { "Closed loop with both maps" }
        p { "The firmware's controller on the dynamic plant with the identified effects." }
        @if let Some(index) = rebuild.most_shortened() { (course(rebuild, index)) }
        (moves(rebuild))
    }
}

fn map(caption: &str, nominal: &ValveTable, rebuilt: &ValveTable) -> Markup {
    let points = |table: &ValveTable| -> (Vec<f64>, Vec<f64>) {
        let point = |point: &hitch_quantities::calibration::valve_table::ValvePoint| {
            (
                f64::from(point.current.0) * 1e-3,
                f64::from(point.flow.0) * LPM_PER_UL_S,
            )
        };
        table.used().iter().map(point).unzip()
    };
    let (nominal, rebuilt) = (points(nominal), points(rebuilt));
    let line =
        |name, stroke, (x, y): &'_ (Vec<f64>, Vec<f64>)| (name, stroke, x.clone(), y.clone());
    let lines = [
        line("nominal", Stroke::Before, &nominal),
        line("rebuilt", Stroke::After, &rebuilt),
    ];
    chart(caption.to_owned(), ["current, A", "flow, l/min"], &lines)
}

type Drawn = (&'static str, Stroke, Vec<f64>, Vec<f64>);

fn chart(caption: String, [x_title, y_title]: [&str; 2], lines: &[Drawn]) -> Markup {
    let lines = lines
        .iter()
        .map(|(name, stroke, x, y)| Line {
            name,
            stroke: *stroke,
            x,
            y,
        })
        .collect();
    Chart {
        caption,
        x_title,
        y_title,
        lines,
    }
    .figure()
}

/// Angle and lowering current of one move with both maps.
fn course(rebuild: &Rebuild, index: usize) -> Markup {
    let order = &rebuild.before.results[index];
    let end_s = order.took_s().max(rebuild.after.results[index].took_s()) + AFTER_S;
    let column = |run: &LoopRun, value: fn(&Sample) -> f64| -> (Vec<f64>, Vec<f64>) {
        let shown = run.traces[index]
            .samples
            .iter()
            .filter(|sample| sample.time_s <= end_s);
        shown.map(|sample| (sample.time_s, value(sample))).unzip()
    };
    let line = |name, stroke, run: &LoopRun, value: fn(&Sample) -> f64| -> Drawn {
        let (x, y) = column(run, value);
        (name, stroke, x, y)
    };
    let current = |sample: &Sample| {
        f64::from(
            sample
                .outputs
                .lower_current
                .0
                .max(sample.outputs.lift_current.0),
        ) * 1e-3
    };
    let angles = [
        line("set point", Stroke::Measured, &rebuild.before, |sample| {
            sample.lever_deg
        }),
        line("nominal", Stroke::Before, &rebuild.before, |sample| {
            sample.angle_deg
        }),
        line("rebuilt", Stroke::After, &rebuild.after, |sample| {
            sample.angle_deg
        }),
    ];
    let currents = [
        line("nominal", Stroke::Before, &rebuild.before, current),
        line("rebuilt", Stroke::After, &rebuild.after, current),
    ];
    let name = format!(
        "{:.1} to {:.1} degrees at {:.0} kg",
        order.from_deg, order.to_deg, order.load_kg
    );
    html! {
        (legend(&[(Stroke::Measured, "set point"), (Stroke::Before, "nominal map"), (Stroke::After, "rebuilt map")]))
        div.grid {
            (chart(format!("Rocker angle, {name}"), ["time, s", "angle, deg"], &angles))
            (chart(format!("Coil current, {name}"), ["time, s", "current, A"], &currents))
        }
    }
}

fn moves(rebuild: &Rebuild) -> Markup {
    let rows: Vec<Vec<String>> = rebuild
        .before
        .results
        .iter()
        .zip(&rebuild.after.results)
        .map(|(before, after)| {
            let pair =
                |before: f64, after: f64| format!("{} → {}", known(before, 2), known(after, 2));
            vec![
                format!(
                    "{:.1} to {:.1} deg, {:.0} kg",
                    before.from_deg, before.to_deg, before.load_kg
                ),
                pair(before.time_s, after.time_s),
                known(before.shortest_s, 2),
                pair(before.ratio, after.ratio),
                pair(before.overshoot_deg, after.overshoot_deg),
                pair(before.final_error_deg, after.final_error_deg),
            ]
        })
        .collect();
    let header = [
        "move",
        "time, s",
        "shortest, s",
        "ratio",
        "overshoot, deg",
        "final error, deg",
    ];
    page::table(&header, &rows)
}
