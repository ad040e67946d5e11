//! Step responses laid over each other: the same move at every load, and at every oil temperature.
use maud::{Markup, html};

use super::occurring;
use crate::closed_loop::{LoopRun, MoveResult, MoveTrace};
use crate::report::chart::{Chart, Line, Stroke, legend};

/// What is shown after the slowest has arrived, s.
const AFTER_S: f64 = 0.4;
/// A line each; more values than lines are not told apart.
const STROKES: [Stroke; 3] = [Stroke::After, Stroke::Before, Stroke::Other];

type Driven<'a> = (&'a MoveResult, &'a MoveTrace);

/// What differs between the lines of a chart, and what stays.
struct Over {
    title: &'static str,
    unit: &'static str,
    varies: fn(&MoveResult) -> f64,
    stays: fn(&MoveResult) -> f64,
    stays_unit: &'static str,
    /// How to have more than one, in words and on the command line.
    more: (&'static str, &'static str),
}

const OVER: [Over; 2] = [
    Over {
        title: "Steps over load",
        unit: "kg",
        varies: |result| result.load_kg,
        stays: |result| result.oil_temperature_c,
        stays_unit: "°C",
        more: ("others are driven without ", "--load"),
    },
    Over {
        title: "Steps over oil temperature",
        unit: "°C",
        varies: |result| result.oil_temperature_c,
        stays: |result| result.load_kg,
        stays_unit: "kg",
        more: ("others are driven with ", "--scenario limits"),
    },
];

/// The sections.
pub fn section(run: &LoopRun) -> Markup {
    html! { @for over in &OVER { (overlaid(run, over)) } }
}

fn overlaid(run: &LoopRun, over: &Over) -> Markup {
    let values = occurring(&run.results, over.varies);
    let stays = occurring(&run.results, over.stays);
    // The middle one of what stays: neither the easiest nor the hardest.
    let fixed = stays[stays.len() / 2];
    let names: Vec<String> = values
        .iter()
        .map(|value| format!("{value:.0} {}", over.unit))
        .collect();
    let entries: Vec<(Stroke, &str)> = [(Stroke::Measured, "set point")]
        .into_iter()
        .chain(STROKES.into_iter().zip(names.iter().map(String::as_str)))
        .collect();
    html! {
        h2 { (over.title) }
        @if values.len() < 2 {
            p { "All moves have " (names[0]) "; " (over.more.0) code { (over.more.1) } "." }
        } @else {
            p { "At " (format!("{fixed:.0}")) " " (over.stays_unit) "." }
            (legend(&entries))
            div.grid {
                @for way in occurring(&run.results, |result| (result.from_deg, result.to_deg)) {
                    (chart(&lines_of(run, over, fixed, way), &names))
                }
            }
        }
    }
}

/// The moves of one chart, in the order of what varies.
fn lines_of<'a>(run: &'a LoopRun, over: &Over, fixed: f64, way: (f64, f64)) -> Vec<Driven<'a>> {
    let belongs = |(result, _): &Driven| {
        (result.from_deg, result.to_deg) == way && (over.stays)(result) == fixed
    };
    run.results
        .iter()
        .zip(&run.traces)
        .filter(belongs)
        .take(STROKES.len())
        .collect()
}

fn chart(driven: &[Driven], names: &[String]) -> Markup {
    let slowest_s = driven
        .iter()
        .map(|(result, _)| result.took_s())
        .fold(0.0, f64::max);
    let columns: Vec<[Vec<f64>; 3]> = driven
        .iter()
        .map(|(_, trace)| {
            let shown = || {
                let samples = trace.samples.iter();
                samples.take_while(|sample| sample.time_s <= slowest_s + AFTER_S)
            };
            [
                shown().map(|sample| sample.time_s).collect(),
                shown().map(|sample| sample.angle_deg).collect(),
                shown().map(|sample| sample.lever_deg).collect(),
            ]
        })
        .collect();
    let hitches = columns.iter().zip(STROKES).zip(names);
    let hitches = hitches.map(|(([x, y, _], stroke), name)| Line { name, stroke, x, y });
    let set_point = columns.first().map(|[x, _, y]| Line {
        name: "set point",
        stroke: Stroke::Measured,
        x,
        y,
    });
    let caption = driven.first().map_or_else(String::new, |(result, _)| {
        format!("{:.1} to {:.1} degrees", result.from_deg, result.to_deg)
    });
    Chart {
        caption,
        x_title: "time, s",
        y_title: "angle, deg",
        lines: set_point.into_iter().chain(hitches).collect(),
    }
    .figure()
}
