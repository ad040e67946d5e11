//! Report sections: the rebuilt valve map, and the closed loop with it.

use hitch_quantities::calibration::valve_table::{ValvePoint, ValveTable};
use maud::{Markup, html};

use super::chart::{Chart, Stroke};
use super::drawn::drawn;
use super::page;
use super::same_move::compared;
use crate::closed_loop::MoveResult;
use crate::closed_loop::rebuild::Rebuild;
use crate::closed_loop::show::name;
use hitch_output::text::known;

/// Conversion from microlitres per second to litres per minute.
const LPM_PER_UL_S: f64 = 60e-6;

/// The sections.
pub fn sections(rebuild: &Rebuild) -> Markup {
    html! {
        h2 { "Rebuilt valve map" }
        p { "Coil current over flow: from the data sheet (nominal), and from the identified model (rebuilt)." }
        (valve_maps(rebuild))
        h2 { "Closed loop with both maps" }
        p { "The firmware's controller on the dynamic plant with the identified effects." }
        @if let Some(index) = rebuild.most_shortened() { (course(rebuild, index)) }
        (moves(rebuild))
    }
}

fn valve_maps(rebuild: &Rebuild) -> Markup {
    let points = |table: &ValveTable| -> (Vec<f64>, Vec<f64>) {
        let point = |point: &ValvePoint| {
            (
                f64::from(point.current.0) * 1e-3,
                f64::from(point.flow.0) * LPM_PER_UL_S,
            )
        };
        table.used().iter().map(point).unzip()
    };
    let maps = [
        ("Lift valve", &rebuild.nominal.lift, &rebuild.rebuilt.lift),
        (
            "Lowering valve",
            &rebuild.nominal.lower,
            &rebuild.rebuilt.lower,
        ),
    ];
    let maps = maps.map(|(caption, nominal, rebuilt)| Chart {
        caption: caption.to_owned(),
        axes: ["current, A", "flow, l/min"],
        lines: vec![
            ("nominal".to_owned(), Stroke::Before, points(nominal)),
            ("rebuilt".to_owned(), Stroke::After, points(rebuilt)),
        ],
    });
    drawn("Flow of both valves over the coil current", &maps)
}

/// One move with both maps.
fn course(rebuild: &Rebuild, index: usize) -> Markup {
    let order = &rebuild.before.results[index];
    html! {
        h3 { (format!("{:.1} to {:.1} degrees at {:.0} kg", order.from_deg, order.to_deg, order.load_kg)) }
        (compared(&[("nominal map", &rebuild.before), ("rebuilt map", &rebuild.after)], index))
    }
}

fn moves(rebuild: &Rebuild) -> Markup {
    let pair = |before: f64, after: f64| format!("{} → {}", known(before, 2), known(after, 2));
    let row = |(before, after): (&MoveResult, &MoveResult)| {
        [
            format!("{} deg, {:.0} kg", name(before), before.load_kg),
            pair(before.time_s, after.time_s),
            known(before.shortest_s, 2),
            pair(before.ratio, after.ratio),
            pair(before.overshoot_deg, after.overshoot_deg),
            pair(before.final_error_deg, after.final_error_deg),
        ]
    };
    let both = rebuild.before.results.iter().zip(&rebuild.after.results);
    let header = [
        "move",
        "time, s",
        "shortest, s",
        "ratio",
        "overshoot, deg",
        "final error, deg",
    ];
    page::table(&header, both.map(row))
}
