//! Which physics is missing: effects are tried, the best is believed or not, and so on until nothing more is worth it.
//!
//! Belief rests on two things together: a likelihood ratio that counts autocorrelated residuals at their effective
//! number, Bonferroni-corrected for all that was tried, and a smaller error in runs that were not used to fit. After
//! every addition each earlier effect has to be needed still, and the form of each is chosen anew. At the end each
//! named effect is tried against those whose signature is nearly its own: what fits as well is said to be
//! indistinguishable.

use super::adequacy::{Cell, adequate, cells, cells_since};
use super::attribution::{Attribution, attribute};
use super::belief::{Proof, believed};
use super::beside::beside_others;
use super::candidate::{Candidate, weigh};
use super::design::{Alternative, NextExperiment, Pair, Rival, next_experiment};
use super::estimate::Estimate;
use super::experiment::Experiment;
use super::fit::{Fit, evaluate, evaluate_weighted, fit, refine, with_last};
use super::forms::reformed;
use super::holdout::{HeldOut, held_out, held_out_beside};
use super::regime::Regime;
use super::scans::Scans;
use super::swap::{MOST_SWAPS, is_likelier, swap};
use super::trials::{Trials, VISIBLE};
use super::twins::twins;
use super::unseen::{Unseen, unseen};
use crate::effects::{AddedEffect, Effect};
use crate::model::Model;

/// Fewest compared samples that anything is concluded from.
const FEWEST_SAMPLES: usize = 50;

/// Most effects that are added.
const MOST_STEPS: usize = 5;

/// What so many effects leave at more than this error, and the last of them at more than this share of what it found,
/// no further one explains either: it is no campaign of this plant.
const LOST_STEPS: usize = 2;
const LOST: f64 = 4.0;
const LITTLE_HELP: f64 = 0.8;

/// Most candidates of one round that are tried on held-out runs.
const MOST_TRIED: usize = 3;

/// Most rounds of adding: an effect that was dropped may come back, but not for ever.
const MOST_ROUNDS: usize = 2 * MOST_STEPS;

/// What an explanation comes to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// The model was adequate as it was.
    NothingMissing,
    /// With the named effects the model is adequate.
    Explained,
    /// Adequate, but some named effect could be another.
    Ambiguous,
    /// Something is left that is not in the catalogue.
    Unexplained,
    /// The campaign cannot decide.
    NotEnoughData,
}

impl Verdict {
    /// Name in reports and JSON.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::NothingMissing => "nothing-missing",
            Self::Explained => "explained",
            Self::Ambiguous => "ambiguous",
            Self::Unexplained => "unexplained",
            Self::NotEnoughData => "not-enough-data",
        }
    }
}

/// An effect that was added.
#[derive(Debug, Clone)]
pub struct Step {
    /// Which effect.
    pub effect: &'static dyn Effect,
    /// Error of the model before the step.
    pub error_before: f64,
    /// Error with the effect.
    pub error_after: f64,
    /// What the model before the step leaves in held-out runs.
    pub held_out_before: HeldOut,
    /// What it leaves there with the effect.
    pub held_out_after: HeldOut,
    /// Probability that the effect is there beside the other steps', shared evenly with those that it cannot be told
    /// from.
    pub confidence: f64,
    /// Root mean square of its projected signature, in sigmas.
    pub detectability: f64,
    /// Effects that would explain the campaign as well in its place.
    pub indistinguishable: Vec<Alternative>,
    /// Values of its parameters in the final model.
    pub values: Vec<f64>,
    /// Their 95 % intervals.
    pub intervals: Vec<(f64, f64)>,
    /// The model after the step, as it was fitted then.
    pub fit: Fit,
    /// Effects that explained next to nothing of what this one did when it was found: none is indistinguishable.
    pub(super) unlike: Vec<&'static str>,
}

/// The way from a model to one that explains a campaign.
#[derive(Debug, Clone)]
pub struct Explanation {
    /// The model before, with its nuisances fitted.
    pub before: Fit,
    /// The model after the last step.
    pub after: Fit,
    /// The steps in order.
    pub steps: Vec<Step>,
    /// What it comes to.
    pub verdict: Verdict,
    /// Cells of the residuals after the last step, worst first.
    pub cells: Vec<Cell>,
    /// What the rest goes with; empty if the rest is noise.
    pub rest: Attribution,
    /// What to measure next if the campaign cannot decide, or not between two effects.
    pub next_experiment: Option<NextExperiment>,
    /// Effects that the campaign would not show; empty if what it does show is not explained.
    pub unseen: Vec<Unseen>,
}

/// A campaign and a model with every effect of the catalogue tried once.
#[derive(Debug, Clone)]
pub struct Diagnosis {
    /// The model as it is, with its nuisances fitted.
    pub base: Fit,
    /// Effects tried, the most likely first.
    pub candidates: Vec<Candidate>,
    /// Probability of each candidate among all and none.
    pub confidences: Vec<f64>,
}

/// Told of what is being done, for progress displays.
pub type Progress<'a> = &'a (dyn Fn(&str) + Sync);

/// Fits what is free in a model as it is.
#[must_use]
pub fn fit_base(experiment: &Experiment, model: &Model) -> Fit {
    let start = Estimate::new(experiment, model.effects.clone());
    if model.effects.is_empty() {
        refine(experiment, model, start)
    } else {
        fit(experiment, model, start)
    }
}

/// Tries every effect that the model does not have.
#[must_use]
pub fn diagnose(
    experiment: &Experiment,
    model: &Model,
    base: Fit,
    progress: Progress,
) -> Diagnosis {
    let absent = showing(experiment, model, &base.estimate);
    let scans = Scans::default();
    let cells = cells(experiment, &base);
    let trials = Trials::new(
        experiment,
        model,
        (&cells, &base),
        &absent,
        &scans,
        progress,
    );
    let (candidates, confidences) = (trials.all_weighed(), trials.confidences());
    drop(trials);
    Diagnosis {
        base,
        candidates,
        confidences,
    }
}

/// Effects that the plant can have and the estimate has not.
pub(super) fn absent(model: &Model, estimate: &Estimate) -> Vec<&'static dyn Effect> {
    possible(model)
        .filter(|effect| !has(estimate, *effect))
        .collect()
}

/// Those of them that show in a channel that the experiment has. An angle sensor that nobody logged is no explanation.
pub(super) fn showing(
    experiment: &Experiment,
    model: &Model,
    estimate: &Estimate,
) -> Vec<&'static dyn Effect> {
    let mut absent = absent(model, estimate);
    absent.retain(|effect| {
        let mut channels = effect.channels().iter();
        channels.any(|channel| experiment.measures(*channel))
    });
    absent
}

/// Effects that the plant can have.
pub(super) fn possible(model: &Model) -> impl Iterator<Item = &'static dyn Effect> {
    let dynamics = model.constants().dynamics;
    let effects = model.catalogue().into_iter();
    effects.filter(move |effect| effect.needs().is_none_or(|needed| needed == dynamics))
}

fn has(estimate: &Estimate, effect: &dyn Effect) -> bool {
    estimate
        .effects
        .iter()
        .any(|added| added.effect.id() == effect.id())
}

/// Names, adds and repeats until nothing more is worth adding.
#[must_use]
pub fn explain(experiment: &Experiment, model: &Model, progress: Progress) -> Explanation {
    let given = model.effects.len();
    let before = fit_base(experiment, model);
    let cells_before = cells(experiment, &before);
    let mut present = before.clone();
    let mut present_held_out = HeldOut::NONE;
    let mut steps: Vec<Step> = Vec::new();
    let scans = Scans::default();
    for _ in 0..MOST_ROUNDS {
        let lost = steps.len() >= LOST_STEPS
            && present.error() > LOST
            && steps
                .last()
                .is_some_and(|last| last.error_after > LITTLE_HELP * last.error_before);
        if !enough(&before) || steps.len() == MOST_STEPS || lost {
            break;
        }
        let absent = showing(experiment, model, &present.estimate);
        let base = (cells_before.as_slice(), &present);
        let trials = Trials::new(experiment, model, base, &absent, &scans, progress);
        if present_held_out.error.is_nan() {
            present_held_out = held_out(experiment, model, &present);
        }
        let proof = Proof::new(trials.visible(), present_held_out, steps.len());
        let Some((best, left)) = proven(experiment, model, &trials, proof) else {
            break;
        };
        steps.push(Step {
            effect: best.effect,
            error_before: present.error(),
            error_after: best.fit.error(),
            held_out_before: present_held_out,
            held_out_after: left,
            confidence: f64::NAN,
            detectability: best.detectability,
            indistinguishable: Vec::new(),
            values: Vec::new(),
            intervals: Vec::new(),
            fit: best.fit.clone(),
            unlike: trials.unlike(&best),
        });
        present = best.fit;
        present_held_out = left;
        if let Some(lighter) = drop_needless(experiment, model, &present, given, &mut steps) {
            present_held_out = held_out(experiment, model, &lighter);
            present = lighter;
        }
        if steps.len() > 1
            && let Some(other) = reformed(experiment, model, &cells_before, &present, given)
        {
            restate(experiment, model, &other, given, &mut steps);
            present_held_out = steps
                .last()
                .map_or(present_held_out, |last| last.held_out_after);
            present = other;
        }
    }
    finish(experiment, model, before, present, (steps, MOST_SWAPS))
}

/// The most likely believable candidate that leaves less in held-out runs than there was without it, and that.
///
/// The likeliest may fail here though it is there: a leak that only one run shows is misjudged from the others as long
/// as another effect is missing, and so is how much thicker the oil of the one cold run is. Then its usual form goes
/// first, or the next effect.
fn proven(
    experiment: &Experiment,
    model: &Model,
    trials: &Trials,
    proof: Proof,
) -> Option<(Candidate, HeldOut)> {
    let tested = |candidate: Candidate| {
        let left = held_out(experiment, model, &candidate.fit);
        let beside = || held_out_beside(experiment, model, &candidate.fit, trials.base());
        let admitted = proof.admits(left) || beside().is_some_and(|left| proof.admits(left));
        admitted.then_some((candidate, left))
    };
    trials
        .likely(believed)
        .filter(|candidate| proof.accepts(experiment, candidate))
        .take(MOST_TRIED)
        .find_map(|candidate| {
            tested(candidate.clone()).or_else(|| {
                let plainer = trials.plainer(candidate)?;
                let accepted = proof.accepts(experiment, &plainer);
                accepted.then(|| tested(plainer)).flatten()
            })
        })
}

/// Drops the first step whose effect the later ones have made needless; returns the fit without it.
fn drop_needless(
    experiment: &Experiment,
    model: &Model,
    present: &Fit,
    given: usize,
    steps: &mut Vec<Step>,
) -> Option<Fit> {
    for index in 0..steps.len().saturating_sub(1) {
        let weighed = beside_others(experiment, model, present, given + index);
        if weighed.candidate.likelihood_ratio < believed(steps[index].effect) {
            steps.remove(index);
            return Some(weighed.without);
        }
    }
    None
}

/// States the steps from the first one on whose effect is another now, or has another form, as they would have been
/// with that.
pub(super) fn restate(
    experiment: &Experiment,
    model: &Model,
    after: &Fit,
    given: usize,
    steps: &mut [Step],
) {
    let effects = &after.estimate.effects[given..];
    let name = |effect: &dyn Effect| (effect.id(), effect.form());
    let other = |(added, step): (&AddedEffect, &Step)| name(added.effect) != name(step.effect);
    let Some(first) = effects.iter().zip(steps.iter()).position(other) else {
        return;
    };
    for index in first..steps.len() {
        let earlier = index.checked_sub(1).map(|earlier| &steps[earlier]);
        let before = earlier.map(|earlier| (earlier.error_after, earlier.held_out_after));
        let mut estimate = after.estimate.clone();
        estimate.effects.truncate(given + index + 1);
        let whole = estimate.effects.len() == after.estimate.effects.len();
        let step = &mut steps[index];
        if let Some((error, held_out)) = before {
            (step.error_before, step.held_out_before) = (error, held_out);
        }
        step.effect = effects[index].effect;
        step.fit = if whole {
            after.clone()
        } else {
            refine(experiment, model, estimate)
        };
        step.error_after = step.fit.error();
        step.held_out_after = held_out(experiment, model, &step.fit);
    }
}

fn finish(
    experiment: &Experiment,
    model: &Model,
    before: Fit,
    after: Fit,
    (mut steps, swaps): (Vec<Step>, usize),
) -> Explanation {
    let given = model.effects.len();
    let (mut faint, mut likelier) = (None, None);
    for (index, step) in steps.iter_mut().enumerate() {
        let effect = given + index;
        let whole = with_last(experiment, model, &after, effect);
        let base = evaluate(experiment, model, after.estimate.without(effect));
        let weighed = weigh(experiment, model, &base, step.effect, whole.clone());
        if weighed.detectability < VISIBLE {
            // A later step has taken over what this one stood for, unless nothing else gets there without it.
            let lighter = refine(experiment, model, after.estimate.without(effect));
            let estimate = lighter.estimate.clone();
            let compared = evaluate_weighted(experiment, model, estimate, after.weights.clone());
            let fallen = (compared.cost - after.cost) / (after.variance() * weighed.inflation);
            if fallen < believed(step.effect) {
                faint = Some((index, lighter));
                break;
            }
        }
        let there = 1.0 / (1.0 + (-weighed.log_odds()).exp());
        step.values = weighed.values().to_vec();
        step.intervals = weighed.intervals;
        step.detectability = weighed.detectability;
        let named = (&whole, weighed.inflation);
        step.indistinguishable = twins(experiment, model, named, &step.unlike);
        if swaps > 0 && step.indistinguishable.iter().any(is_likelier) {
            likelier = Some(index);
            break;
        }
        step.confidence = there / (1 + step.indistinguishable.len()) as f64;
    }
    if let Some((index, lighter)) = faint {
        steps.remove(index);
        return finish(experiment, model, before, lighter, (steps, swaps));
    }
    if let Some(index) = likelier {
        let after = swap(experiment, model, &after, (given, index), &mut steps).unwrap_or(after);
        return finish(experiment, model, before, after, (steps, swaps - 1));
    }
    let cells = cells_since(&cells(experiment, &before), experiment, &after);
    let missing = missing_manoeuvre(experiment, &after);
    let verdict = verdict(experiment, &cells, &steps, &after, missing);
    let rest = if verdict == Verdict::Unexplained {
        attribute(experiment, &before, &after)
    } else {
        Attribution::default()
    };
    let next_experiment = match verdict {
        Verdict::Ambiguous => next_experiment(experiment, model, &pairs(&after, &steps)),
        Verdict::NotEnoughData => missing.map(NextExperiment::missing),
        _ => None,
    };
    let unseen = match verdict {
        Verdict::Unexplained => Vec::new(),
        _ => unseen(experiment, model, &after),
    };
    Explanation {
        before,
        after,
        steps,
        verdict,
        cells,
        rest,
        next_experiment,
        unseen,
    }
}

/// Every named effect with each that could stand in its place.
fn pairs<'a>(after: &'a Fit, steps: &'a [Step]) -> Vec<Pair<'a>> {
    let of_step = |step: &'a Step| {
        step.indistinguishable.iter().map(|alternative| Pair {
            named: Rival {
                effect: step.effect,
                fit: after,
            },
            other: Rival {
                effect: alternative.effect,
                fit: &alternative.fit,
            },
        })
    };
    steps.iter().flat_map(of_step).collect()
}

fn verdict(
    experiment: &Experiment,
    cells: &[Cell],
    steps: &[Step],
    after: &Fit,
    missing: Option<&str>,
) -> Verdict {
    if !enough(after) {
        Verdict::NotEnoughData
    } else if !adequate(experiment, cells, after) {
        Verdict::Unexplained
    } else if steps.is_empty() && missing.is_some() {
        Verdict::NotEnoughData
    } else if steps.is_empty() {
        Verdict::NothingMissing
    } else if steps.iter().any(|step| !step.indistinguishable.is_empty()) {
        Verdict::Ambiguous
    } else {
        Verdict::Explained
    }
}

/// Whether there is anything to tell an effect from noise by.
fn enough(fit: &Fit) -> bool {
    fit.weights.count() >= FEWEST_SAMPLES
}

/// The manoeuvre without which a campaign cannot clear a model, if it lacks one.
fn missing_manoeuvre(experiment: &Experiment, fit: &Fit) -> Option<&'static str> {
    let seen = |wanted: Regime| {
        let regimes = experiment.runs.iter().flat_map(|run| &run.regimes);
        regimes.filter(|&&regime| regime == wanted).count() >= FEWEST_SAMPLES
    };
    if !enough(fit) {
        Some(
            "log at least a few seconds of pressure, flow or angle while lifting, holding and lowering",
        )
    } else if !seen(Regime::Lifting) {
        Some("lift at two currents or more: no run keeps the lift valve open")
    } else if !seen(Regime::Lowering) {
        Some("lower at two currents or more: no run keeps the lowering valve open")
    } else {
        None
    }
}
