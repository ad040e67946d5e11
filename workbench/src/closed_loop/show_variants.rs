//! Several calibrations side by side, as tables for terminal and report.

use super::metrics::{MoveResult, Summary};
use super::moves::LoopRun;
use super::rate::{PressResult, PressRun, PressSummary};
use super::show::name;
use crate::text::{Table, known};

/// Runs with the names of their calibrations.
pub type Named<'a, Run> = &'a [(&'a str, &'a Run)];

/// A table: header and rows.
#[derive(Debug, Clone)]
pub struct Sides {
    /// Header.
    pub header: Vec<String>,
    /// Rows; the first cell is the name.
    pub rows: Vec<Vec<String>>,
}

impl Sides {
    fn new<Run>(first: &[&str], runs: Named<'_, Run>) -> Self {
        let names = runs.iter().map(|(name, _)| *name);
        let header = first.iter().copied().chain(names);
        Self {
            header: header.map(str::to_owned).collect(),
            rows: Vec::new(),
        }
    }

    fn row(
        &mut self,
        first: impl IntoIterator<Item = String>,
        cells: impl IntoIterator<Item = String>,
    ) {
        self.rows.push(first.into_iter().chain(cells).collect());
    }

    fn text(&self) -> String {
        let mut table = Table::new(self.header.iter().map(String::as_str));
        for row in &self.rows {
            table.row(row.clone());
        }
        table.to_string()
    }
}

/// A figure: its name, its value in a summary, and its decimals.
type Figure<Of> = (&'static str, fn(&Of) -> f64, usize);

const MOVES: [Figure<Summary>; 8] = [
    ("moves that arrived", |all| all.arrived as f64, 0),
    ("time ratio, median", |all| all.ratio_median, 2),
    ("time ratio, 95 %", |all| all.ratio_p95, 2),
    (
        "tracking error, median, deg",
        |all| all.tracking_error_median_deg,
        2,
    ),
    ("largest overshoot, deg", |all| all.overshoot_max_deg, 2),
    ("largest final error, deg", |all| all.final_error_max_deg, 2),
    (
        "largest pressure swing",
        |all| all.pressure_swing_ratio_max,
        2,
    ),
    (
        "coil activations after arrival",
        |all| f64::from(all.switched_on_after),
        0,
    ),
];

const PRESSES: [Figure<PressSummary>; 4] = [
    (
        "error of the steady speed, %",
        |all| 100.0 * all.speed_error_max,
        1,
    ),
    (
        "largest overshoot of the speed, %",
        |all| 100.0 * all.speed_overshoot_max,
        1,
    ),
    ("latest start, s", |all| all.start_delay_max_s, 3),
    ("latest stop, s", |all| all.stop_delay_max_s, 3),
];

/// The figures of all moves, by calibration.
#[must_use]
pub fn figures(runs: Named<'_, LoopRun>) -> Sides {
    let mut sides = Sides::new(&["figure"], runs);
    for (name, of, digits) in MOVES {
        sides.row(
            [name.to_owned()],
            runs.iter().map(|(_, run)| known(of(&run.summary), digits)),
        );
    }
    sides
}

/// The figures of all presses, by calibration.
#[must_use]
pub fn press_figures(runs: Named<'_, PressRun>) -> Sides {
    let mut sides = Sides::new(&["figure"], runs);
    for (name, of, digits) in PRESSES {
        sides.row(
            [name.to_owned()],
            runs.iter().map(|(_, run)| known(of(&run.summary), digits)),
        );
    }
    sides
}

/// Time ratio and overshoot of each move, by calibration.
#[must_use]
pub fn moves(runs: Named<'_, LoopRun>) -> Sides {
    let mut sides = Sides::new(&["move, deg", "load, kg", "oil, C"], runs);
    let cell = |result: &MoveResult| {
        if result.arrived {
            format!("{} / {:.2}", known(result.ratio, 2), result.overshoot_deg)
        } else {
            "never arrives".to_owned()
        }
    };
    for (index, result) in runs
        .first()
        .map_or(&[][..], |(_, run)| &run.results)
        .iter()
        .enumerate()
    {
        let conditions = [
            name(result),
            format!("{:.0}", result.load_kg),
            format!("{:.0}", result.oil_temperature_c),
        ];
        sides.row(
            conditions,
            runs.iter().map(|(_, run)| cell(&run.results[index])),
        );
    }
    sides
}

/// Start delay and overshoot of each press, by calibration.
#[must_use]
pub fn presses(runs: Named<'_, PressRun>) -> Sides {
    let mut sides = Sides::new(&["button, deg/s", "load, kg", "oil, C"], runs);
    let cell = |press: &PressResult| {
        let start = known(press.start_delay_s, 2);
        format!("{start} / {:.1}", 100.0 * press.speed_overshoot)
    };
    for (index, press) in runs
        .first()
        .map_or(&[][..], |(_, run)| &run.results)
        .iter()
        .enumerate()
    {
        let conditions = [
            format!("{:+.1}", press.rate_deg_per_s),
            format!("{:.0}", press.load_kg),
            format!("{:.0}", press.oil_temperature_c),
        ];
        sides.row(
            conditions,
            runs.iter().map(|(_, run)| cell(&run.results[index])),
        );
    }
    sides
}

/// Meaning of the cells of [`moves`], and of [`presses`].
pub const MOVE_CELLS: &str = "Each cell: time over the shortest time / overshoot, deg.";
/// See [`MOVE_CELLS`].
pub const PRESS_CELLS: &str =
    "Each cell: time until half of the speed, s / overshoot of the speed, %.";

/// Moves with several calibrations, for a terminal.
#[must_use]
pub fn moves_text(runs: Named<'_, LoopRun>) -> String {
    format!(
        "{}\n{MOVE_CELLS}\n\n{}\n",
        moves(runs).text(),
        figures(runs).text()
    )
}

/// Presses with several calibrations, for a terminal.
#[must_use]
pub fn presses_text(runs: Named<'_, PressRun>) -> String {
    format!(
        "{}\n{PRESS_CELLS}\n\n{}\n",
        presses(runs).text(),
        press_figures(runs).text()
    )
}
