//! Suggestion of a formula for residuals that the catalogue does not explain: a candidate for a user-defined term, not
//! an identified cause.
//!
//! A typed grammar (`shapes`) writes terms at every place that acts on channels with lack of fit, as functions of the
//! signals on which the residuals depend. Each is a [`TermEffect`]: it is simulated at a small size and ranked by the
//! cost reduction of its signature after the free parameters are projected out (`screen`). The best few are fitted like
//! effects of the catalogue and judged by the error in held-out runs, not by how well a curve matches the residuals.
//!
//! The explanation may contain effects of the catalogue that stand in for the true one. The search therefore starts
//! twice, from the model without them and from the model with them, and prefers the former unless the latter is better.

mod screen;
mod shapes;
mod spread;

use hitch_effects::TermEffect;
use hitch_effects::expression::TermDefinition;
use hitch_plant::Effect;

use crate::data::problem::Problem;
use crate::estimation::fit::{Fit, evaluate, refine};
use crate::explanation::explain::{Explanation, Verdict};
use crate::search::candidates::Progress;
use crate::search::screening::EXPLAINED;
use crate::search::single_effects::try_effects;
use crate::selection::candidate::{Candidate, weigh};
use crate::selection::evidence::SIGNIFICANT;
use crate::selection::hold_out::{HeldOut, held_out};

/// Screened terms that are fitted, per start.
const FITTED: usize = 5;

/// The same for a plant with pressure ringing, whose simulations are far slower.
const FITTED_RINGING: usize = 3;

/// Fitted terms that are evaluated on held-out runs, per start.
const HELD_OUT: usize = 2;

/// Share of the excess squared error in held-out runs that a suggested term has to remove.
const WORTH_OFFERING: f64 = 0.25;

/// Remaining share of it below which the second start is skipped.
const SETTLED: f64 = 0.1;

/// Relative increase of the held-out error that is accepted for one parameter less.
const PER_PARAMETER: f64 = 0.01;

/// Significant digits of the values in the definition.
const DIGITS: usize = 3;

/// A suggested term.
#[derive(Debug, Clone)]
pub struct Suggestion {
    /// The term, with the fitted values as start values of its parameters.
    pub term: &'static TermEffect,
    /// Its fitted values.
    pub values: Vec<f64>,
    /// Their 95 % intervals.
    pub intervals: Vec<(f64, f64)>,
    /// Error of the explanation's final model in held-out runs.
    pub held_out_before: HeldOut,
    /// Error with the term in held-out runs.
    pub held_out_after: HeldOut,
    /// The model with the term and with those steps of the explanation that are still needed.
    pub fit: Fit,
    /// Steps of the explanation that are not needed with the term.
    pub unneeded: Vec<&'static dyn Effect>,
}

/// Searches for a term if the verdict of an explanation is [`Verdict::Unexplained`], unless the error that it leaves is in single
/// cells only: a term is judged by the error of whole runs.
#[must_use]
pub fn suggest(
    problem: Problem<'_>,
    found: &Explanation,
    progress: Progress,
) -> Option<Suggestion> {
    if found.verdict != Verdict::Unexplained || found.after.error() <= EXPLAINED {
        return None;
    }
    let last = found.steps.last().map(|step| step.held_out_after);
    let present = last.unwrap_or_else(|| held_out(problem, &found.before));
    let excess = |left: HeldOut| left.excess().max(0.0);
    let mut tried = trials(problem, found, &found.before, progress);
    let least = tried
        .iter()
        .map(|trial| excess(trial.held_out))
        .fold(excess(present), f64::min);
    if !found.steps.is_empty() && least > SETTLED * excess(present) {
        tried.extend(trials(problem, found, &found.after, progress));
    }
    let best = tried
        .into_iter()
        .min_by(|a, b| a.score().total_cmp(&b.score()))?;
    let left = excess(best.held_out) / excess(present);
    (left < 1.0 - WORTH_OFFERING).then(|| best.suggestion(problem, found, present))
}

/// A term fitted on a start, and its error in held-out runs.
struct Trial {
    term: &'static TermEffect,
    candidate: Candidate,
    held_out: HeldOut,
}

impl Trial {
    /// Error in held-out runs, penalised by the number of parameters.
    fn score(&self) -> f64 {
        let effects = &self.candidate.fit.estimate.effects;
        let parameters: usize = effects.iter().map(|added| added.values.len()).sum();
        self.held_out.loss * (1.0 + PER_PARAMETER * parameters as f64)
    }

    fn suggestion(
        self,
        problem: Problem<'_>,
        found: &Explanation,
        held_out_before: HeldOut,
    ) -> Suggestion {
        let Problem { model, .. } = problem;
        let given = model.effects.len();
        let (candidate, dropped) = without_unneeded(problem, self.candidate, given);
        let held_out_after = if dropped {
            held_out(problem, &candidate.fit)
        } else {
            self.held_out
        };
        let mut fit = candidate.fit.clone();
        let term = settled(self.term, candidate.values());
        fit.estimate.effects[candidate.index].effect = term;
        let kept = |effect: &dyn Effect| {
            let mut effects = fit.estimate.effects.iter();
            effects.any(|added| added.effect.id() == effect.id())
        };
        let steps = found.steps.iter().map(|step| step.effect);
        let unneeded = steps.filter(|effect| !kept(*effect)).collect();
        Suggestion {
            term,
            values: candidate.values().to_vec(),
            intervals: candidate.intervals,
            held_out_before,
            held_out_after,
            unneeded,
            fit,
        }
    }
}

/// The most promising terms added to a start, fitted and evaluated on held-out runs.
fn trials(
    problem: Problem<'_>,
    found: &Explanation,
    start: &Fit,
    progress: Progress,
) -> Vec<Trial> {
    let Problem { experiment, .. } = problem;
    let definitions = shapes::definitions(problem, start, &found.rest.depends_on);
    let count = if experiment.ringing {
        FITTED_RINGING
    } else {
        FITTED
    };
    let terms = screen::best(problem, start, definitions, count);
    let effects: Vec<&'static dyn Effect> = terms.iter().map(|term| *term as &dyn Effect).collect();
    let tried = try_effects(problem, start, &effects, progress);
    tried
        .iter()
        .filter(|candidate| candidate.likelihood_ratio >= SIGNIFICANT)
        .take(HELD_OUT)
        .filter_map(|candidate| {
            let id = candidate.effect.id();
            let term = terms.iter().copied().find(|term| term.id() == id)?;
            Some(Trial {
                term,
                held_out: held_out(problem, &candidate.fit),
                candidate: candidate.clone(),
            })
        })
        .filter(|trial| trial.held_out.loss.is_finite())
        .collect()
}

/// The candidate without the steps that are not needed with it, and whether there were any.
fn without_unneeded(
    problem: Problem<'_>,
    mut candidate: Candidate,
    given: usize,
) -> (Candidate, bool) {
    let mut dropped = false;
    let mut index = given;
    while index < candidate.index {
        let mut reduced = candidate.fit.estimate.clone();
        reduced.effects.remove(index);
        let reduced = refine(problem, reduced);
        let whole = evaluate(problem, candidate.fit.estimate.clone());
        let needed = weigh(problem, &reduced, whole, index).likelihood_ratio >= SIGNIFICANT;
        if needed {
            index += 1;
        } else {
            dropped = true;
            candidate.fit = reduced;
            candidate.index -= 1;
        }
    }
    if dropped {
        let mut without = candidate.fit.estimate.clone();
        without.effects.remove(candidate.index);
        let base = refine(problem, without);
        candidate = weigh(problem, &base, candidate.fit, candidate.index);
    }
    (candidate, dropped)
}

/// The same term with its fitted values, rounded, as the start values of its parameters.
fn settled(term: &'static TermEffect, values: &[f64]) -> &'static TermEffect {
    let mut definition: TermDefinition = term.term().definition().clone();
    for (parameter, value) in definition.parameters.iter_mut().zip(values) {
        parameter.start = rounded(*value).clamp(parameter.low, parameter.high);
    }
    TermEffect::define(definition).unwrap_or(term)
}

fn rounded(value: f64) -> f64 {
    let last = DIGITS - 1;
    format!("{value:.last$e}").parse().unwrap_or(value)
}
