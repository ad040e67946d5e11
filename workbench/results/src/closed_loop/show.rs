//! Moves as tables and text, for terminal and report.

use super::metrics::{MoveResult, Summary};
use super::rate::{PressResult, PressSummary};
use hitch_output::text::{Table, joined, known, wrapped};

/// Header of the table of moves, for terminal and report.
pub const HEADER: [&str; 9] = [
    "move, deg",
    "load, kg",
    "time, s",
    "shortest, s",
    "ratio",
    "overshoot, deg",
    "final error, deg",
    "active after, s",
    "pressure swing",
];

/// Name of a move.
#[must_use]
pub fn name(result: &MoveResult) -> String {
    format!("{:.1} to {:.1}", result.from_deg, result.to_deg)
}

/// Row of a move under [`HEADER`].
#[must_use]
pub fn row(result: &MoveResult) -> [String; 9] {
    [
        name(result),
        format!("{:.0}", result.load_kg),
        if result.arrived {
            known(result.time_s, 3)
        } else {
            "never arrives".to_owned()
        },
        if result.shortest_s.is_finite() {
            known(result.shortest_s, 3)
        } else {
            "impossible".to_owned()
        },
        known(result.ratio, 2),
        format!("{:.2}", result.overshoot_deg),
        format!("{:.2}", result.final_error_deg),
        format!("{:.3}", result.active_after_s),
        known(result.pressure_swing_ratio, 2),
    ]
}

/// The figures as a table for a terminal.
#[must_use]
pub fn text(moves: &[MoveResult], summary: &Summary) -> String {
    let table = Table::of(HEADER, moves.iter().map(row));
    let lines = summed_up(summary);
    format!("{table}\n{}\n", joined(lines.lines().map(wrapped), "\n"))
}

/// Presses of the external button as a table for a terminal, with the worst figures.
#[must_use]
pub fn presses_text(presses: &[PressResult], summary: &PressSummary) -> String {
    let mut table = Table::new([
        "button, deg/s",
        "load, kg",
        "oil, C",
        "speed ratio",
        "start, s",
        "stop, s",
        "overshoot, %",
        "travel after, deg",
    ]);
    for press in presses {
        table.row([
            format!("{:+.1}", press.rate_deg_per_s),
            format!("{:.0}", press.load_kg),
            format!("{:.0}", press.oil_temperature_c),
            known(press.speed_ratio, 3),
            known(press.start_delay_s, 3),
            known(press.stop_delay_s, 3),
            format!("{:.1}", 100.0 * press.speed_overshoot),
            format!("{:.2}", press.travel_after_deg),
        ]);
    }
    let summary = format!(
        "Steady speed: at most {} % off the requested one; largest overshoot {} %. \
         Latest start {} s, latest stop {} s.",
        known(100.0 * summary.speed_error_max, 1),
        known(100.0 * summary.speed_overshoot_max, 1),
        known(summary.start_delay_max_s, 3),
        known(summary.stop_delay_max_s, 3),
    );
    format!("{table}\n{}\n", wrapped(&summary))
}

/// The summary in two lines, and a third one if a move did not arrive.
#[must_use]
pub fn summed_up(summary: &Summary) -> String {
    let arrived = match summary.moves - summary.arrived {
        0 => String::new(),
        never => format!(
            "{never} of {} moves never arrived; the time ratios exclude them.\n",
            summary.moves
        ),
    };
    format!(
        "{arrived}Time ratio: median {}, 95 % quantile {}; largest overshoot {:.2} deg, \
         largest final error {:.2} deg.\n\
         Coil activations in the minute after arrival: {}; longest on time in that minute: {:.3} s.\n",
        known(summary.ratio_median, 2),
        known(summary.ratio_p95, 2),
        summary.overshoot_max_deg,
        summary.final_error_max_deg,
        summary.switched_on_after,
        summary.active_after_max_s,
    )
}
