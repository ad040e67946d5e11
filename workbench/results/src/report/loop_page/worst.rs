//! Worst-case map: each figure over move, load and oil temperature.
use maud::{Markup, html};

use super::occurring;
use crate::closed_loop::MoveResult;
use crate::report::page::folded;
use crate::web::heat_table::{HeatTable, Shade};

/// A figure of a move with its colour scale.
pub(super) struct Figure {
    name: &'static str,
    pub(super) of: fn(&MoveResult) -> f64,
    /// White: ideal value.
    best: f64,
    /// Yellow: limit for the motion. Orange: as far above it.
    bar: f64,
}

/// The figures by which a move may be the worst.
pub(super) const FIGURES: [Figure; 4] = [
    Figure {
        name: "Time ratio: time over the shortest time with edges of 100 ms",
        of: |result| result.ratio,
        best: 1.0,
        bar: 1.4,
    },
    Figure {
        name: "Overshoot, deg",
        of: |result| result.overshoot_deg,
        best: 0.0,
        bar: 0.3,
    },
    Figure {
        name: "Final error, deg",
        of: |result| result.final_error_deg,
        best: 0.0,
        bar: 0.3,
    },
    Figure {
        name: "Pressure swing relative to the ideal manoeuvre",
        of: |result| result.pressure_swing_ratio,
        best: 0.5,
        bar: 1.5,
    },
];

/// The section.
pub fn section(results: &[MoveResult]) -> Markup {
    html! {
        h2 { "Worst moves" }
        p { "White: ideal. Yellow: at the limit. Orange: as far over the limit as the limit is over the ideal. \
             Rows: moves, in degrees. Columns: load and oil temperature. A dash: the move never arrives \
             or is impossible."  }
        @for figure in &FIGURES {
            h3 { (figure.name) }
            (shown(results, figure))
        }
    }
}

fn shown(results: &[MoveResult], figure: &Figure) -> Markup {
    let table = table(results, figure);
    folded(&table.table(), table.rows.len())
}

fn table(results: &[MoveResult], figure: &Figure) -> HeatTable {
    let way = |result: &MoveResult| (result.from_deg, result.to_deg);
    let place = |result: &MoveResult| (result.load_kg, result.oil_temperature_c);
    let places = occurring(results, place);
    let cell = |way_of_row: (f64, f64), place_of_column: (f64, f64)| {
        let here =
            |result: &&MoveResult| way(result) == way_of_row && place(result) == place_of_column;
        results.iter().filter(here).map(figure.of).reduce(f64::max)
    };
    HeatTable {
        corner: "move".to_owned(),
        columns: places
            .iter()
            .map(|(load_kg, oil_c)| format!("{load_kg:.0} kg {oil_c:.0} °C"))
            .collect(),
        rows: occurring(results, way)
            .into_iter()
            .map(|row| {
                let name = format!("{:.1} to {:.1}", row.0, row.1);
                let cells = places.iter().map(|&place| cell(row, place)).collect();
                (name, cells)
            })
            .collect(),
        shade: Shade::Bar {
            best: figure.best,
            bar: figure.bar,
        },
    }
}
