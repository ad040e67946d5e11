//! One move driven with two calibrations.

use maud::Markup;

use super::chart::Stroke;
use super::drawn::{Drawn, Points, drawn};
use crate::closed_loop::{LoopRun, Sample};

/// Time shown after the later arrival, s.
const AFTER_S: f64 = 0.5;

/// Angle and coil current of a move, given by its index; `names` are those of the calibrations.
pub fn compared(before: &LoopRun, after: &LoopRun, index: usize, names: [&str; 2]) -> Markup {
    let order = &before.results[index];
    let end_s = order.took_s().max(after.results[index].took_s()) + AFTER_S;
    let points = |run: &LoopRun, value: fn(&Sample) -> f64| -> Points {
        let samples = run.traces[index].samples.iter();
        let shown = samples.take_while(|sample| sample.time_s <= end_s);
        shown.map(|sample| (sample.time_s, value(sample))).unzip()
    };
    let both = |value: fn(&Sample) -> f64| {
        let [first, second] = names.map(str::to_owned);
        [
            (first, Stroke::Before, points(before, value)),
            (second, Stroke::After, points(after, value)),
        ]
    };
    let set_point = (
        "set point".to_owned(),
        Stroke::Measured,
        points(before, |sample| sample.lever_deg),
    );
    let angles = [set_point]
        .into_iter()
        .chain(both(|sample| sample.angle_deg));
    let charts = [
        Drawn {
            caption: "Rocker angle".to_owned(),
            axes: ["time, s", "angle, deg"],
            lines: angles.collect(),
        },
        Drawn {
            caption: "Coil current".to_owned(),
            axes: ["time, s", "current, A"],
            lines: both(|sample| {
                let outputs = &sample.outputs;
                f64::from(outputs.lower_current.0.max(outputs.lift_current.0)) * 1e-3
            })
            .into(),
        },
    ];
    let label = format!(
        "Angle and coil current from {:.1} to {:.1} degrees with both calibrations",
        order.from_deg, order.to_deg
    );
    drawn(&label, &charts)
}
