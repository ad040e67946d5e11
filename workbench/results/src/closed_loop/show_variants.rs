//! Several calibrations side by side, as tables for terminal and report.

use super::metrics::{MoveResult, Summary};
use super::moves::LoopRun;
use super::rate::{PressResult, PressRun, PressSummary};
use super::show::name;
use hitch_output::text::{Table, known};

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

    /// A row for each figure of the summaries of the runs.
    fn of_figures<Run, Of>(
        runs: Named<'_, Run>,
        figures: &[Figure<Of>],
        summary: fn(&Run) -> Of,
    ) -> Self {
        let mut sides = Self::new(&["figure"], runs);
        for (name, of, digits) in figures {
            let cells = runs
                .iter()
                .map(|(_, run)| known(of(&summary(run)), *digits));
            sides
                .rows
                .push([(*name).to_owned()].into_iter().chain(cells).collect());
        }
        sides
    }

    /// A row for each result of the runs: its name with its load, kg, and oil temperature, C, and a cell for each run.
    fn of_results<Run, Of>(
        kind: &str,
        runs: Named<'_, Run>,
        results: fn(&Run) -> &[Of],
        row: impl Fn(&Of) -> (String, f64, f64),
        cell: impl Fn(&Of) -> String,
    ) -> Self {
        let mut sides = Self::new(&[kind, "load, kg", "oil, C"], runs);
        let first = runs.first().map_or(&[][..], |(_, run)| results(run));
        for (index, result) in first.iter().enumerate() {
            let (name, load_kg, oil_c) = row(result);
            let conditions = [name, format!("{load_kg:.0}"), format!("{oil_c:.0}")];
            let cells = runs.iter().map(|(_, run)| cell(&results(run)[index]));
            sides
                .rows
                .push(conditions.into_iter().chain(cells).collect());
        }
        sides
    }

    fn text(&self) -> String {
        let header = self.header.iter().map(String::as_str);
        Table::of(header, self.rows.iter().cloned()).to_string()
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
    Sides::of_figures(runs, &MOVES, |run| run.summary)
}

/// The figures of all presses, by calibration.
#[must_use]
pub fn press_figures(runs: Named<'_, PressRun>) -> Sides {
    Sides::of_figures(runs, &PRESSES, |run| run.summary)
}

/// Time ratio and overshoot of each move, by calibration.
#[must_use]
pub fn moves(runs: Named<'_, LoopRun>) -> Sides {
    let row = |result: &MoveResult| (name(result), result.load_kg, result.oil_temperature_c);
    let cell = |result: &MoveResult| {
        if result.arrived {
            format!("{} / {:.2}", known(result.ratio, 2), result.overshoot_deg)
        } else {
            "never arrives".to_owned()
        }
    };
    Sides::of_results("move, deg", runs, |run| &run.results, row, cell)
}

/// Start delay and overshoot of each press, by calibration.
#[must_use]
pub fn presses(runs: Named<'_, PressRun>) -> Sides {
    let row = |press: &PressResult| {
        let speed = format!("{:+.1}", press.rate_deg_per_s);
        (speed, press.load_kg, press.oil_temperature_c)
    };
    let cell = |press: &PressResult| {
        let start = known(press.start_delay_s, 2);
        format!("{start} / {:.1}", 100.0 * press.speed_overshoot)
    };
    Sides::of_results("button, deg/s", runs, |run| &run.results, row, cell)
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
