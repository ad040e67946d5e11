//! The manoeuvre that shows more of an error that no effect of the catalogue explains.
//!
//! There is no rival model that a likelihood ratio could be computed with. The manoeuvre varies the signal that the
//! remaining error depends on most, while the others stay the same or return to the same values.

use hitch_plant::Model;

use crate::adequacy::signal::Signal;
use crate::data::experiment::Experiment;
use crate::data::problem::Problem;
use crate::data::regime::Regime;
use crate::design::feasibility::is_feasible;
use crate::design::levels::Levels;
use crate::design::manoeuvre::TEMPLATES;
use crate::design::next::NextExperiment;
use crate::design::plan::Manoeuvre;
use crate::estimation::fit::Fit;

/// Sample rate of the feasibility check, Hz.
const RATE_HZ: f64 = 50.0;

/// The manoeuvre for an unexplained error that depends on these signals, the most important first.
#[must_use]
pub fn exploring(problem: Problem<'_>, fit: &Fit, depends_on: &[Signal]) -> NextExperiment {
    let Problem {
        experiment, model, ..
    } = problem;
    let levels = Levels::new(experiment, model);
    let machine = fit.estimate.applied_to(model);
    let lifting = is_while_lifting(experiment, fit);
    let signals = depends_on.iter().chain(&[Signal::Load, Signal::Flow]);
    let proposals = signals.map(|signal| proposal(*signal, lifting));
    let mut possible = proposals.filter_map(|(name, why)| {
        let manoeuvre = named(name, &levels, &machine)?;
        Some(NextExperiment::exploring(&manoeuvre, why))
    });
    possible.next().unwrap_or_else(|| {
        NextExperiment::missing(
            "repeat the run with the largest error with another load and with other currents",
        )
    })
}

/// A listed manoeuvre, if the machine can carry it out.
fn named(name: &str, levels: &Levels, machine: &Model) -> Option<Manoeuvre> {
    let template = TEMPLATES.iter().find(|template| template.name == name)?;
    let manoeuvre = template.on(levels);
    is_feasible(&manoeuvre, levels, machine, RATE_HZ).then_some(manoeuvre)
}

/// Name of the manoeuvre that varies a signal, and the reason.
fn proposal(signal: Signal, lifting: bool) -> (&'static str, String) {
    let of = |lift, lower| if lifting { lift } else { lower };
    let (name, varies) = match signal {
        Signal::LiftCurrent => (
            "slow-lift-triangle",
            "it passes each lift current twice, in both directions",
        ),
        Signal::LowerCurrent => (
            "slow-lowering-triangle",
            "it passes each lowering current twice, in both directions",
        ),
        Signal::CylinderPressure | Signal::Load => (
            of("light-and-heavy-lift", "light-and-heavy-lowering"),
            "it varies the pressure at the same currents",
        ),
        Signal::Flow => (
            of("lift-staircase", "lowering-staircase"),
            "it has each flow long enough to settle",
        ),
        Signal::RockerAngle => (
            "creep-and-stop",
            "it moves slowly at two loads, so that pressure and angle are independent",
        ),
        Signal::OilTemperature => ("cold-and-warm", "it varies the viscosity alone"),
        Signal::Time => (
            "hold-at-two-loads",
            "at rest a drift of an instrument differs from a leak, which depends on the load",
        ),
    };
    let why = format!("the unexplained error depends on {signal}, and {varies}");
    (name, why)
}

/// Whether the squared residuals per sample are larger while lifting than while lowering.
fn is_while_lifting(experiment: &Experiment, fit: &Fit) -> bool {
    let mean_square = |wanted: Regime| {
        let (mut sum, mut samples) = (0.0, 0.0_f64);
        for (run, residuals) in experiment.runs.iter().zip(&fit.residuals) {
            for (sample, regime) in run.regimes.iter().enumerate() {
                if *regime == wanted {
                    let channels = residuals.iter().skip(sample).step_by(run.len());
                    sum += channels.map(|residual| residual * residual).sum::<f64>();
                    samples += 1.0;
                }
            }
        }
        sum / samples.max(1.0)
    };
    mean_square(Regime::Lifting) > mean_square(Regime::Lowering)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_signal_has_a_listed_manoeuvre() {
        for signal in Signal::ALL {
            for lifting in [true, false] {
                let (name, _) = proposal(signal, lifting);
                assert!(
                    TEMPLATES.iter().any(|template| template.name == name),
                    "{name}"
                );
            }
        }
    }
}
