//! The manoeuvre that shows more of an error that no effect of the catalogue explains.
//!
//! There is no rival model that a likelihood ratio could be computed with. The manoeuvre goes where the error is
//! ([`ErrorMap`]), and varies the signal there that the error depends on most.

use crate::adequacy::signal::Signal;
use crate::data::problem::Problem;
use crate::design::error_map::ErrorMap;
use crate::design::feasibility::is_feasible;
use crate::design::levels::Levels;
use crate::design::manoeuvre::TEMPLATES;
use crate::design::next::NextExperiment;
use crate::design::plan::Manoeuvre;
use crate::design::proposal::{Expecting, Proposal};
use crate::estimation::fit::Fit;
use crate::parallel;

/// Sample rate of the feasibility check, Hz.
const RATE_HZ: f64 = 50.0;

/// Share of the most that a manoeuvre shows of the error from which one that varies the right signal is taken instead.
const ENOUGH: f64 = 0.5;

/// The manoeuvre for an unexplained error that depends on these signals, the most important first: one that varies them
/// where the error is, else the one that shows most of it.
#[must_use]
pub fn exploring(problem: Problem<'_>, fit: &Fit, depends_on: &[Signal]) -> NextExperiment {
    let Problem {
        experiment, model, ..
    } = problem;
    let levels = Levels::new(experiment, model);
    let machine = fit.estimate.applied_to(model);
    let errors = ErrorMap::of(experiment, fit, &machine, &levels);
    let feasible = parallel::map(TEMPLATES, |template| {
        let manoeuvre = template.on(&levels);
        is_feasible(&manoeuvre, &levels, &machine, RATE_HZ).then(|| {
            let shown = errors.shown_by(&manoeuvre, &machine, &levels, RATE_HZ);
            (template.name, manoeuvre, shown)
        })
    });
    let listed: Vec<(&'static str, Manoeuvre, f64)> = feasible.into_iter().flatten().collect();
    let most = listed.iter().max_by(|a, b| a.2.total_cmp(&b.2));
    let Some((_, most, largest)) = most else {
        return NextExperiment::missing(
            "repeat the run with the largest error with another load and with other currents",
        );
    };
    let signals = depends_on.iter().chain(&[Signal::Load, Signal::Flow]);
    let varied = signals.flat_map(|signal| {
        let (names, varies) = proposal(*signal);
        names.into_iter().map(move |name| (*signal, name, varies))
    });
    let mut visiting = varied.filter_map(|(signal, name, varies)| {
        let (_, manoeuvre, shown) = listed.iter().find(|(listed, ..)| *listed == name)?;
        (*shown >= ENOUGH * largest).then_some((signal, manoeuvre, varies))
    });
    let (manoeuvre, varies) = match visiting.next() {
        Some((signal, manoeuvre, varies)) if depends_on.contains(&signal) => {
            (manoeuvre, format!("it depends on {signal}, and {varies}"))
        }
        Some((_, manoeuvre, varies)) => (manoeuvre, varies.to_owned()),
        None => (most, "this manoeuvre goes there".to_owned()),
    };
    let place = errors
        .worst()
        .map(|place| format!("the unexplained error is largest {place}"));
    let why: Vec<String> = place.into_iter().chain([varies]).collect();
    let proposal = Proposal {
        manoeuvre: manoeuvre.clone(),
        channels: experiment.noise.map(f64::is_finite),
        models: vec![Expecting {
            title: "the present model".to_owned(),
            model: machine.clone(),
        }],
    };
    NextExperiment::exploring(proposal, &why.join("; "))
}

/// Names of the manoeuvres that vary a signal, and how.
fn proposal(signal: Signal) -> (Vec<&'static str>, &'static str) {
    match signal {
        Signal::LiftCurrent => (
            vec!["slow-lift-triangle"],
            "it passes each lift current twice, in both directions",
        ),
        Signal::LowerCurrent => (
            vec!["slow-lowering-triangle"],
            "it passes each lowering current twice, in both directions",
        ),
        Signal::CylinderPressure | Signal::Load => (
            vec!["light-and-heavy-lift", "light-and-heavy-lowering"],
            "it varies the pressure at the same currents",
        ),
        Signal::Flow => (
            vec!["lift-staircase", "lowering-staircase"],
            "it has each flow long enough to settle",
        ),
        Signal::RockerAngle => (
            vec!["creep-and-stop", "down-to-the-ground", "dead-head"],
            "it reaches the same angles with other pressures",
        ),
        Signal::OilTemperature => (vec!["cold-and-warm"], "it varies the viscosity alone"),
        Signal::Time => (
            vec!["hold-at-two-loads"],
            "at rest a drift of an instrument differs from a leak, which depends on the load",
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_signal_has_a_listed_manoeuvre() {
        for signal in Signal::ALL {
            for name in proposal(signal).0 {
                assert!(
                    TEMPLATES.iter().any(|template| template.name == name),
                    "{name}"
                );
            }
        }
    }
}
