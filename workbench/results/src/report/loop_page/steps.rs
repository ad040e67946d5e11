//! Superimposed step responses: the same move at every load, and at every oil temperature.
use maud::{Markup, html};

use super::occurring;
use crate::closed_loop::{LoopRun, MoveResult, MoveTrace};
use crate::report::chart::{Chart, Stroke};
use crate::report::drawn::drawn;

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
    let ways = occurring(&run.results, |result| (result.from_deg, result.to_deg));
    let charts: Vec<Chart<'static>> = ways
        .into_iter()
        .map(|way| chart(&lines_of(run, over, fixed, way), &names))
        .collect();
    html! {
        h2 { (over.title) }
        @if values.len() < 2 {
            p { "All moves have " (names[0]) "; " (over.more.0) code { (over.more.1) } "." }
        } @else {
            p { "At " (format!("{fixed:.0}")) " " (over.stays_unit) "." }
            (drawn(over.title, &charts))
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

fn chart(driven: &[Driven], names: &[String]) -> Chart<'static> {
    let times = driven.iter().map(|(result, _)| result.took_s());
    let end_s = times.fold(0.0, f64::max) + AFTER_S;
    let set_point = driven.first().map(|(_, trace)| {
        let points = trace.points(end_s, |sample| sample.lever_deg);
        ("set point".to_owned(), Stroke::Measured, points)
    });
    let hitches = driven.iter().zip(STROKES).zip(names);
    let hitches = hitches.map(|(((_, trace), stroke), name)| {
        let points = trace.points(end_s, |sample| sample.angle_deg);
        (name.clone(), stroke, points)
    });
    let caption = driven.first().map_or_else(String::new, |(result, _)| {
        format!("{:.1} to {:.1} degrees", result.from_deg, result.to_deg)
    });
    Chart::over_time(caption, "angle, deg", set_point.into_iter().chain(hitches))
}
