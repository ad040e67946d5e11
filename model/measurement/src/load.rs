//! Loads that contradict the pressure at rest, by the other runs.

use hitch_plant::Channel;

use crate::finding::{Evidence, Finding, Kind};
use crate::logs::{FAR, Logs};
use crate::rest_pressure::{Level, Line, rests};
use crate::statistics::spread_about;

/// Share of the pressure that friction may hold at rest.
const FRICTION: f64 = 0.2;

/// A run whose pressure belongs to another load.
struct Wrong {
    run: usize,
    load_kg: f64,
    fitting_kg: f64,
    accuracy_kg: f64,
}

/// The wrong loads, except of runs whose pressures are known to be wrong.
pub(crate) fn findings(logs: &Logs, wrong_pressures: &[Finding]) -> Vec<Finding> {
    let mut rests = rests(logs);
    let named = |run| {
        wrong_pressures
            .iter()
            .any(|finding| finding.is_in(logs.campaign, run))
    };
    rests.retain(|rest| !named(rest.run));
    let Some(line) = Line::through(&rests) else {
        return Vec::new();
    };
    let best = rests.iter().map(|rest| (rest.run, rest.best(&line)));
    let excess_bar = |level: &Level| level.measured_bar - line.bar(level);
    let spread_bar = spread_about(best.clone().map(|(_, level)| excess_bar(&level)), 0.0);
    let far_bar = FAR * spread_bar.max(logs.noise_of(Channel::CylinderPressure));
    let wrong = best.filter_map(|(run, level)| {
        let held_bar = FRICTION * level.measured_bar.max(line.bar(&level));
        let bar_per_kg = line.bar_per_kg(&level);
        let is_wrong = excess_bar(&level).abs() > far_bar.max(held_bar) && bar_per_kg > 0.0;
        is_wrong.then(|| Wrong {
            run,
            load_kg: level.load_kg,
            fitting_kg: (level.load_kg + excess_bar(&level) / bar_per_kg).max(0.0),
            accuracy_kg: far_bar.max(0.5 * held_bar) / bar_per_kg,
        })
    });
    let wrong: Vec<Wrong> = wrong.collect();
    // A line from which many runs deviate is not that of the weight.
    if wrong.len() * 3 > rests.len() {
        return Vec::new();
    }
    wrong.iter().map(|one| finding(logs, one, &wrong)).collect()
}

fn finding(logs: &Logs, one: &Wrong, all: &[Wrong]) -> Finding {
    let fits = |a: &Wrong, b: &Wrong| (a.fitting_kg - b.load_kg).abs() < a.accuracy_kg;
    let partner = all
        .iter()
        .find(|other| fits(one, other) && fits(other, one));
    let also = partner.map_or_else(String::new, |other| {
        let file = &logs.runs()[other.run].file;
        format!(", the load of {file}, whose pressure fits the load of this run")
    });
    let seen = format!(
        "The pressure at rest is that of {:.0} kg by the other runs, not {:.0} kg{also}.",
        one.fitting_kg, one.load_kg
    );
    let cure = match partner {
        Some(_) => "Exchange the load_kg of the two runs, if their records allow it.",
        None => "Correct load_kg of this run or its unit, or the zero of its pressure.",
    };
    let evidence = Evidence::new(one.fitting_kg, one.accuracy_kg, "kg");
    Finding::new(Kind::Load, evidence, seen, cure)
        .in_run(logs.campaign, one.run)
        .of(Channel::CylinderPressure.key())
}
