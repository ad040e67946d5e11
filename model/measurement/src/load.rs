//! Loads that contradict the pressure at rest, by the other runs.

use hitch_plant::Channel;

use crate::finding::{Evidence, Finding, Kind};
use crate::logs::{FAR, Logs};
use crate::rest_pressure::{Line, Rest, rests};
use crate::statistics::quantile;

/// Share of the pressure that friction may hold at rest.
const FRICTION: f64 = 0.2;
/// Kilograms in a pound.
const POUND_KG: f64 = 0.4536;

/// A run whose pressure belongs to another load.
struct Wrong<'a> {
    rest: &'a Rest,
    fitting_kg: f64,
    accuracy_kg: f64,
}

/// The wrong loads, except of runs whose pressures are known to be wrong.
pub(crate) fn findings(logs: &Logs, wrong_pressures: &[Finding]) -> Vec<Finding> {
    let (mut rests, _) = rests(logs);
    let named = |run: usize| {
        wrong_pressures
            .iter()
            .any(|finding| finding.is_in(logs.campaign, run))
    };
    rests.retain(|rest| !named(rest.run));
    let Some(line) = Line::through(&mut rests) else {
        return Vec::new();
    };
    let friction_bar = quantile(rests.iter().map(|rest| rest.band_bar(&line)), 0.75);
    let sigma_bar = logs
        .noise_of(Channel::CylinderPressure)
        .max(line.spread_bar);
    let wrong: Vec<Wrong> = rests
        .iter()
        .filter_map(|rest| wrong(&line, sigma_bar, friction_bar, rest))
        .collect();
    // A line from which many runs deviate is not that of the weight.
    if wrong.len() * 3 > rests.len() {
        return Vec::new();
    }
    wrong.iter().map(|one| finding(logs, one, &wrong)).collect()
}

fn wrong<'a>(line: &Line, sigma_bar: f64, friction_bar: f64, rest: &'a Rest) -> Option<Wrong<'a>> {
    let level = &rest.best;
    let excess_bar = line.excess_bar(level);
    let weight_bar = (line.slope * level.weight).max(level.measured_bar);
    let least_bar = (FAR * sigma_bar)
        .max(friction_bar)
        .max(FRICTION * weight_bar);
    let bar_per_kg = line.slope * level.per_kg;
    (excess_bar.abs() > least_bar && bar_per_kg > 0.0).then(|| Wrong {
        rest,
        fitting_kg: (rest.load_kg + excess_bar / bar_per_kg).max(0.0),
        accuracy_kg: (FAR * sigma_bar).max(0.5 * FRICTION * level.measured_bar) / bar_per_kg,
    })
}

fn finding(logs: &Logs, one: &Wrong, all: &[Wrong]) -> Finding {
    let (stated_kg, fitting_kg) = (one.rest.load_kg, one.fitting_kg);
    let fits = |a: &Wrong, b: &Wrong| (a.fitting_kg - b.rest.load_kg).abs() < a.accuracy_kg;
    let partner = all
        .iter()
        .find(|other| fits(one, other) && fits(other, one));
    let pounds =
        (stated_kg * POUND_KG - fitting_kg).abs() < one.accuracy_kg && fitting_kg < stated_kg;
    let (also, cure) = match (partner, pounds) {
        (Some(other), _) => (
            format!(
                ", the load of {}, whose pressure fits the load of this run",
                logs.runs()[other.rest.run].file
            ),
            "Exchange the load_kg of the two runs, if their records allow it.",
        ),
        (None, true) => (
            ", the stated number in pounds".to_owned(),
            "State load_kg in kilograms.",
        ),
        (None, false) => (
            String::new(),
            "Correct load_kg of this run, or the zero of its pressure.",
        ),
    };
    let seen = format!(
        "The pressure at rest is that of {fitting_kg:.0} kg by the other runs, not {stated_kg:.0} kg{also}."
    );
    let evidence = Evidence::new(fitting_kg, one.accuracy_kg, "kg");
    Finding::new(Kind::Load, evidence, seen, cure)
        .in_run(logs.campaign, one.rest.run)
        .of(Channel::CylinderPressure.key())
}
