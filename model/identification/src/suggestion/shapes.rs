//! The grammar of suggestions: combinations of place, signal and shape with a physical meaning.

use hitch_effects::expression::{ParameterDefinition, TermDefinition};
use hitch_input::unit::Unit;
use hitch_plant::Place;
use hitch_plant::hooks::signals::SIGNALS;

use crate::adequacy::signal::Signal;
use crate::data::problem::Problem;
use crate::estimation::fit::Fit;
use crate::suggestion::spread;

/// A place with the unit of sizes there, a typical and the largest size, and the physically plausible signals, the most
/// usual first.
struct PlaceGrammar {
    place: Place,
    unit: &'static str,
    usual: f64,
    largest: f64,
    signals: &'static [&'static str],
}

const fn place_grammar(
    place: Place,
    unit: &'static str,
    [usual, largest]: [f64; 2],
    signals: &'static [&'static str],
) -> PlaceGrammar {
    PlaceGrammar {
        place,
        unit,
        usual,
        largest,
        signals,
    }
}

static PLACES: [PlaceGrammar; 12] = [
    place_grammar(
        Place::LowerFlowFactor,
        "",
        [0.2, 1.0],
        &["x", "q_lower", "p_cyl", "i_lower", "t_oil"],
    ),
    place_grammar(
        Place::LiftFlowFactor,
        "",
        [0.2, 1.0],
        &["x", "q_lift", "p_cyl", "i_lift", "t_oil"],
    ),
    place_grammar(
        Place::LowerCurrent,
        "A",
        [0.05, 0.6],
        &["i_lower", "x", "p_cyl", "t_oil"],
    ),
    place_grammar(
        Place::LiftCurrent,
        "A",
        [0.05, 0.6],
        &["i_lift", "x", "p_cyl", "t_oil"],
    ),
    place_grammar(
        Place::Leakage,
        "l/min",
        [0.2, 10.0],
        &["p_cyl", "x", "t_oil"],
    ),
    place_grammar(
        Place::Friction,
        "N",
        [400.0, 8000.0],
        &["x", "v", "p_cyl", "t_oil"],
    ),
    place_grammar(Place::Weight, "N", [400.0, 8000.0], &["x"]),
    place_grammar(
        Place::CylinderPressureSensor,
        "bar",
        [0.5, 20.0],
        &["p_cyl", "x", "t_oil"],
    ),
    place_grammar(
        Place::AngleSensor,
        "deg",
        [1.0, 15.0],
        &["rocker_angle", "t_oil"],
    ),
    place_grammar(
        Place::FlowSensor,
        "l/min",
        [0.5, 10.0],
        &["q_lift", "q_lower"],
    ),
    place_grammar(
        Place::ReturnPressure,
        "bar",
        [1.0, 30.0],
        &["q_lower", "t_oil"],
    ),
    place_grammar(
        Place::CompensatorMargin,
        "bar",
        [0.3, 4.0],
        &["p_cyl", "q_lift", "i_lift", "t_oil"],
    ),
];

/// Shapes of a term: name, and formula with `S` for the signal and `W` for its scale parameter.
const SHAPES: [(&str, &str); 6] = [
    ("below", "c * ramp(1 - S / W)"),
    ("above", "c * ramp(S / W - 1)"),
    ("saturating", "c * tanh(S / W)"),
    ("bump", "c * exp(-(S / W - 1)^2 / 0.1)"),
    ("wave", "c * sin(W * S + phase)"),
    ("limit", "-c * ramp(1 - W / max(S, 0.1[l/min]))"),
];

/// A signal's display unit, and one of it in SI.
fn unit(signal: &str) -> (&'static str, f64) {
    let known = SIGNALS.iter().find(|known| known.name == signal);
    let unit = known.map_or("", |known| known.written_unit);
    (unit, Unit::parse(unit).map_or(1.0, |unit| unit.si))
}

/// Signals of formulas for a signal of the attribution.
fn signals_of(signal: Signal) -> &'static [&'static str] {
    match signal {
        Signal::RockerAngle => &["x", "rocker_angle"],
        Signal::CylinderPressure | Signal::Load => &["p_cyl"],
        Signal::Flow => &["q_lift", "q_lower", "v"],
        Signal::LiftCurrent => &["i_lift", "q_lift"],
        Signal::LowerCurrent => &["i_lower", "q_lower"],
        Signal::OilTemperature => &["t_oil"],
        Signal::Time => &[],
    }
}

/// Number of signals of the attribution that are used.
const FIRST_NAMES: usize = 3;

/// Root mean square error of a channel, in sigma, above which it has lack of fit.
const OFF: f64 = 1.05;

/// Terms to screen on a fitted model; `depends_on` lists the attribution's signals, the most important first.
#[must_use]
pub fn definitions(problem: Problem<'_>, fit: &Fit, depends_on: &[Signal]) -> Vec<TermDefinition> {
    let wanted: Vec<&str> = depends_on
        .iter()
        .take(FIRST_NAMES)
        .flat_map(|signal| signals_of(*signal).iter().copied())
        .collect();
    let off = |place: Place| {
        let mut channels = place.channels().iter();
        channels.any(|channel| fit.channel_error(channel.index()) > OFF)
    };
    let mut definitions = Vec::new();
    for place_grammar in PLACES
        .iter()
        .filter(|place_grammar| off(place_grammar.place))
    {
        let signals = place_grammar.signals.iter().enumerate();
        for (_, signal) in signals.filter(|(rank, signal)| *rank == 0 || wanted.contains(signal)) {
            if let Some(scales) = spread::quantiles(problem, signal) {
                place_grammar.push(signal, scales, &mut definitions);
            }
        }
    }
    definitions
}

impl PlaceGrammar {
    /// Adds the terms of a signal, with the scale of each shape starting at each of `scales`, SI.
    fn push(&self, signal: &str, scales: [f64; 3], definitions: &mut Vec<TermDefinition>) {
        for (shape, formula) in SHAPES {
            if !self.suits(shape, signal) {
                continue;
            }
            for (rank, scale) in scales.into_iter().enumerate() {
                definitions.push(self.definition(shape, formula, signal, scale, rank));
            }
        }
    }

    fn suits(&self, shape: &str, signal: &str) -> bool {
        let flow = signal.starts_with("q_");
        match shape {
            "limit" => flow && self.unit.is_empty(),
            "wave" => signal == "rocker_angle",
            "bump" => signal == "x" || signal == "rocker_angle",
            "saturating" => signal == "v" || flow,
            _ => signal != "rocker_angle",
        }
    }

    fn definition(
        &self,
        shape: &str,
        formula: &str,
        signal: &str,
        scale: f64,
        rank: usize,
    ) -> TermDefinition {
        let (unit, one) = unit(signal);
        let limit = shape == "limit";
        let mut size = parameter("c", self.unit, self.usual, -self.largest, self.largest);
        if limit {
            (size.start, size.low, size.high) = (0.9, 0.0, 1.0);
        }
        let scale = if shape == "wave" {
            // Cycles per revolution of the shaft, as of an eccentric or a universal joint.
            parameter("turns", "", [1.0, 2.0, 4.0][rank], 0.5, 12.0)
        } else {
            let start = digits(scale / one).max(1e-3);
            let name = match shape {
                "limit" => "limit",
                "bump" => "at",
                "below" => "below",
                "above" => "above",
                _ => "width",
            };
            parameter(name, unit, start, start / 5.0, start * 5.0)
        };
        let directed = if self.place == Place::Friction && signal != "v" {
            formula.replacen("c *", "c * tanh(v / 3[mm/s]) *", 1)
        } else {
            formula.to_owned()
        };
        let formula = directed.replace('S', signal).replace('W', &scale.name);
        let mut parameters = vec![size, scale];
        if shape == "wave" {
            parameters.push(parameter("phase", "deg", 30.0, -200.0, 200.0));
        }
        TermDefinition {
            id: format!("{}-{shape}-{}", self.place.id(), signal.replace('_', "-")),
            title: String::new(),
            place: self.place,
            formula,
            parameters,
        }
    }
}

fn parameter(name: &str, unit: &str, start: f64, low: f64, high: f64) -> ParameterDefinition {
    ParameterDefinition {
        name: name.to_owned(),
        unit: unit.to_owned(),
        meaning: String::new(),
        null: 0.0,
        start,
        low: digits(low),
        high: digits(high),
    }
}

/// A number rounded to two digits, for readable files and few distinct definitions.
fn digits(value: f64) -> f64 {
    format!("{value:.1e}").parse().unwrap_or(value)
}
