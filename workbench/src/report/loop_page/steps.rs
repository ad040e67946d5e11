//! Superimposed step responses: the same move at every load, and at every oil temperature.
use maud::{Markup, html};

use super::occurring;
use crate::closed_loop::{LoopRun, MoveResult, MoveTrace};
use crate::report::chart::{Chart, Line, Stroke, legend};

/// Time shown after the slowest arrival, s.
const AFTER_S: f64 = 0.4;
/// Line styles; further values would be indistinguishable.
const STROKES: [Stroke; 3] = [Stroke::After, Stroke::Before, Stroke::Other];

type Driven<'a> = (&'a MoveResult, &'a MoveTrace);

/// The varied and the constant quantities of a chart.
struct Over {
    title: &'static str,
    unit: &'static str,
    varies: fn(&MoveResult) -> f64,
    stays: fn(&MoveResult) -> f64,
    stays_unit: &'static str,
    /// How to get more values, as text and as option.
    more: (&'static str, &'static str),
}

const OVER: [Over; 2] = [
    Over {
        title: "Step responses over load",
        unit: "kg",
        varies: |result| result.load_kg,
        stays: |result| result.oil_temperature_c,
        stays_unit: "°C",
        more: ("for other loads, omit ", "--load"),
    },
    Over {
        title: "Step responses over oil temperature",
        unit: "°C",
        varies: |result| result.oil_temperature_c,
        stays: |result| result.load_kg,
        stays_unit: "kg",
        more: ("for other temperatures, use ", "--scenario limits"),
    },
];

/// The sections.
pub fn section(run: &LoopRun) -> Markup {
    html! { @for over in &OVER { (overlaid(run, over)) } }
}

fn overlaid(run: &LoopRun, over: &Over) -> Markup {
    let values = occurring(&run.results, over.varies);
    let stays = occurring(&run.results, over.stays);
    // The median of the constant quantity: an average case.
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

/// The moves of one chart, in the order of the varied quantity.
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
