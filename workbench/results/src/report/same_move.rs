//! One move of the lever, or one press of the button, driven with several calibrations.

use maud::{Markup, html};

use super::chart::{Chart, Line, Points, Stroke};
use super::drawn::drawn;
use crate::closed_loop::show_variants::Named;
use crate::closed_loop::{LoopRun, PressRun, PressTrace};

/// Time shown after the last arrival, s.
const AFTER_S: f64 = 0.5;
/// Step of the points of a press, ms.
const EVERY_MS: usize = 10;

/// Angle and coil current of a move, given by its index, with each calibration.
pub fn compared(runs: Named<'_, LoopRun>, index: usize) -> Markup {
    let Some((_, first)) = runs.first() else {
        return html! {};
    };
    let order = &first.results[index];
    let arrivals = runs.iter().map(|(_, run)| run.results[index].took_s());
    let end_s = arrivals.fold(0.0, f64::max) + AFTER_S;
    let each = |value| series(runs, move |run| run.traces[index].points(end_s, value));
    let set_point = (
        "set point".to_owned(),
        Stroke::Measured,
        first.traces[index].points(end_s, |sample| sample.lever_deg),
    );
    let angles = [set_point]
        .into_iter()
        .chain(each(|sample| sample.angle_deg));
    let currents = each(|sample| sample.lift_current_a().max(sample.lower_current_a()));
    let charts = [
        Chart::over_time("Rocker angle", "angle, deg", angles),
        Chart::over_time("Coil current", "current, A", currents),
    ];
    let label = format!(
        "Angle and coil current from {:.1} to {:.1} degrees with each calibration",
        order.from_deg, order.to_deg
    );
    drawn(&label, &charts)
}

/// A line for each calibration.
fn series<Run>(
    runs: Named<'_, Run>,
    points: impl Fn(&Run) -> Points,
) -> impl Iterator<Item = Line> {
    let styles = Stroke::SERIES.into_iter().cycle();
    let line = move |((name, run), stroke): (&(&str, &Run), Stroke)| {
        ((*name).to_owned(), stroke, points(run))
    };
    runs.iter().zip(styles).map(line)
}

/// Speed and angle of the rocker in a press, given by its index, with each calibration.
pub fn pressed(runs: Named<'_, PressRun>, index: usize) -> Markup {
    let Some((_, first)) = runs.first() else {
        return html! {};
    };
    let press = &first.traces[index].press;
    let stops = runs.iter().map(|(_, run)| run.results[index].stop_delay_s);
    let end_s = press.held_s + stops.fold(0.0, f64::max) + AFTER_S;
    let each = |points: fn(&PressTrace) -> Points| {
        series(runs, move |run| {
            let (x, y) = points(&run.traces[index]);
            let shown = x.iter().take_while(|time_s| **time_s <= end_s).count();
            (x[..shown].to_vec(), y[..shown].to_vec())
        })
    };
    let rate = press.rate_deg_per_s;
    let requested = (
        vec![0.0, press.held_s, press.held_s, end_s],
        vec![rate, rate, 0.0, 0.0],
    );
    let requested = ("requested".to_owned(), Stroke::Measured, requested);
    let speeds = each(|trace| trace.speeds_deg_per_s(EVERY_MS));
    let angles = each(|trace| {
        let angles = trace.angles_deg.iter().enumerate().step_by(EVERY_MS);
        angles
            .map(|(ms, angle_deg)| (ms as f64 * 1e-3, *angle_deg))
            .unzip()
    });
    let charts = [
        Chart::over_time(
            "Speed of the rocker, mean over 100 ms",
            "speed, deg/s",
            [requested].into_iter().chain(speeds),
        ),
        Chart::over_time("Rocker angle", "angle, deg", angles),
    ];
    let label =
        format!("Speed and angle of the rocker at {rate:+.1} degrees/s with each calibration");
    drawn(&label, &charts)
}
