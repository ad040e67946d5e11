//! Explanation of a campaign: the identified set of effects, as steps from the model to it.
//!
//! The search ([`crate::search::subset`]) finds the set. Here its members are ordered by the cost reduction they add
//! and weighed against the model with all others (size, interval, detectability, probability). Confounded alternatives
//! are listed, and the remaining residuals are tested for lack of fit.

use std::cell::LazyCell;

use hitch_plant::Effect;

use crate::adequacy::attribution::{Attribution, attribute};
use crate::adequacy::lack_of_fit::{Cell, adequate, cells, cells_since};
use crate::data::experiment::Experiment;
use crate::data::problem::Problem;
use crate::data::regime::Regime;
use crate::design::exploration::exploring;
use crate::design::{Alternative, NextExperiment, Pair, Replacement, Rival, next_experiment};
use crate::estimate::Estimate;
use crate::estimation::fit::{Fit, evaluate, fit, refine};
use crate::explanation::constants::{CorrectedConstants, Searched, search_with_constants};
use crate::explanation::undetected::{Undetected, undetected};
use crate::search::candidates::Progress;
use crate::search::options::{Accuracy, Options};
use crate::search::subset::Found;
use crate::selection::candidate::{Candidate, weigh};
use crate::selection::evidence::DISTINGUISHABLE;
use crate::selection::hold_out::{HeldOut, held_out};
use crate::selection::posterior::{Weighed, key_of, probability_of, probability_of_any};

/// Smallest probability of an effect, or of one of its confounded alternatives, that belongs to an explanation.
const PRESENT: f64 = 0.5;

/// Fewest compared samples for any conclusion.
const FEWEST_SAMPLES: usize = 50;

/// Conclusion of an explanation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// The model is adequate without any change.
    NothingMissing,
    /// The model is adequate with the named effects and, if they are off, with fitted constants.
    Explained,
    /// Adequate, but a named effect is confounded with another.
    Ambiguous,
    /// A lack of fit remains that no effect of the catalogue explains.
    Unexplained,
    /// The campaign has too few data.
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

/// An effect that was added or changed.
#[derive(Debug, Clone)]
pub struct ExplanationStep {
    /// The effect.
    pub effect: &'static dyn Effect,
    /// Error of the model before the step.
    pub error_before: f64,
    /// Error with the effect.
    pub error_after: f64,
    /// Error of the model before the step in held-out runs.
    pub held_out_before: HeldOut,
    /// Error with the effect in held-out runs.
    pub held_out_after: HeldOut,
    /// Posterior probability that the effect is present in addition to those of the other steps; confounded
    /// alternatives share it.
    pub confidence: f64,
    /// Probability that the effect or one of its confounded alternatives is present.
    pub presence: f64,
    /// Root mean square of its projected signature, in sigmas.
    pub detectability: f64,
    /// Share of the mean square beyond noise that the effect explains, weighted by its signature.
    pub explained_share: f64,
    /// Confounded alternatives: effects that would explain the campaign as well in its place.
    pub indistinguishable: Vec<Alternative>,
    /// Other forms of it that would explain the campaign as well; `None` is the form without a name.
    pub other_forms: Vec<Option<&'static str>>,
    /// Values of its parameters in the final model.
    pub values: Vec<f64>,
    /// Their 95 % intervals.
    pub intervals: Vec<(f64, f64)>,
    /// The size before the search; `None` if the effect is new.
    pub changed_from: Option<f64>,
    /// The model after the step, as fitted.
    pub fit: Fit,
}

/// The identified effects of a campaign, with the fits on the way.
#[derive(Debug, Clone)]
pub struct Explanation {
    /// The given model with its nuisance parameters fitted and its effects unchanged.
    pub before: Fit,
    /// The given model with its effects refitted; `None` if it has none.
    pub refitted: Option<Fit>,
    /// The fitted constants, if the declared ones are off.
    pub corrected: Option<CorrectedConstants>,
    /// The model after the last step.
    pub after: Fit,
    /// The steps in order.
    pub steps: Vec<ExplanationStep>,
    /// Effects that reduce the error and are rather absent than present, in the order of their removal, each with the model that
    /// had it.
    pub doubtful: Vec<ExplanationStep>,
    /// The conclusion.
    pub verdict: Verdict,
    /// Cells of the residuals after the last step, by decreasing excess.
    pub cells: Vec<Cell>,
    /// Signals on which the remaining error depends; empty unless the verdict is [`Verdict::Unexplained`].
    pub rest: Attribution,
    /// The experiment to do next if the campaign cannot decide, or not between two effects, or leaves an error
    /// unexplained.
    pub next_experiment: Option<NextExperiment>,
    /// Effects that the campaign could not detect; empty if the verdict is [`Verdict::Unexplained`].
    pub undetected: Vec<Undetected>,
    /// Whether the deadline passed before the search ended.
    pub unfinished: bool,
}

/// Whether an effect has to be the named one in order to stay.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Names {
    /// It has to: an explanation states causes.
    Right,
    /// Something that acts like it has to be there: a model that is adopted predicts.
    Near,
}

impl Names {
    fn of(constants: Accuracy) -> Self {
        match constants {
            Accuracy::DataSheet => Self::Near,
            _ => Self::Right,
        }
    }

    /// Probability that an effect which acts as found counts as present.
    fn weight(self, candidate: &Candidate) -> f64 {
        match self {
            Self::Right => candidate.plausibility(),
            Self::Near => 1.0,
        }
    }
}

/// The effects that a search found.
struct Members {
    steps: Vec<ExplanationStep>,
    doubtful: Vec<ExplanationStep>,
}

/// Fits loads and clocks of a model; its effects stay unchanged.
#[must_use]
pub fn fit_base(problem: Problem<'_>) -> Fit {
    let Problem {
        experiment, model, ..
    } = problem;
    let start = Estimate::new(experiment, model.effects.clone());
    refine(problem, start.with_adopted())
}

/// Fits a model with all its effects.
#[must_use]
pub fn fit_freely(problem: Problem<'_>) -> Fit {
    let Problem {
        experiment, model, ..
    } = problem;
    let start = Estimate::new(experiment, model.effects.clone());
    fit(problem, start)
}

/// Finds missing effects and changed ones of the model.
#[must_use]
pub fn explain(problem: Problem<'_>, progress: Progress) -> Explanation {
    explain_with(problem, Options::default(), progress)
}

/// [`explain`] with options.
#[must_use]
pub fn explain_with(problem: Problem<'_>, options: Options<'_>, progress: Progress) -> Explanation {
    let problem = problem.within(options.limit);
    let Problem { model, .. } = problem;
    let before = fit_base(problem);
    let adopted = !model.effects.is_empty();
    let refitted = adopted.then(|| fit_freely(problem));
    let mut searched = if enough(&before) {
        let limit = options.limit.of_search();
        let options = Options { limit, ..options };
        search_with_constants(problem.within(limit), &before, options, progress)
    } else {
        Searched::declared(Found::nothing(&before))
    };
    progress("how sure that is");
    let names = Names::of(options.constants);
    let mut steps = steps(problem, &before, &searched, names);
    let mut doubtful = Vec::new();
    loop {
        let fewer = steps.iter().rev().skip(1).map(|step| step.fit.clone());
        if let Some(step) = steps.iter().position(may_be_absent) {
            searched.found.remove(problem, step);
        } else if let Some(step) = improbable(&steps) {
            doubtful.push(ExplanationStep {
                fit: searched.found.fit.clone(),
                error_after: searched.found.fit.error(),
                ..steps.remove(step)
            });
            searched.found.remove(problem, step);
        } else if !searched.found.moves_to_fewer(problem, fewer.collect()) {
            break;
        }
        steps = self::steps(problem, &before, &searched, names);
    }
    let members = Members { steps, doubtful };
    concluded(problem, before, refitted, searched, members)
}

/// Whether the interval of a step's size contains its absent value. A single jump that the noise of a current decides
/// can have any likelihood ratio, and is still no evidence.
fn may_be_absent(step: &ExplanationStep) -> bool {
    let null = step.effect.parameters()[0].null;
    let off = step.changed_from.unwrap_or(null);
    match step.intervals.as_slice() {
        [(low, high)] => (*low..=*high).contains(&off),
        _ => false,
    }
}

/// The least probable step, if it and its confounded alternatives are rather absent than present.
fn improbable(steps: &[ExplanationStep]) -> Option<usize> {
    let least =
        (0..steps.len()).min_by(|&a, &b| steps[a].presence.total_cmp(&steps[b].presence))?;
    (steps[least].presence < PRESENT).then_some(least)
}

/// The members of the set as steps, in greedy order of the cost reduction that each adds.
fn steps(
    problem: Problem<'_>,
    before: &Fit,
    searched: &Searched,
    names: Names,
) -> Vec<ExplanationStep> {
    let found = &searched.found;
    let start = searched.corrected.as_ref().unwrap_or(before);
    let weighed = found.refitted.weighed(problem, &found.fit);
    let whole = evaluate(problem, found.fit.estimate.clone());
    let mut steps: Vec<ExplanationStep> = Vec::new();
    for (count, &effect) in found.order.iter().enumerate() {
        let last = count + 1 == found.order.len();
        let fit = if last {
            found.fit.clone()
        } else {
            with_some(problem, found, &found.order[..=count])
        };
        let (error_before, held_out_before) = match steps.last() {
            Some(step) => (step.error_after, step.held_out_after),
            None => (start.error(), held_out(problem, start)),
        };
        let held_out_after = if last {
            found.held_out
        } else {
            held_out(problem, &fit)
        };
        let candidate = weighed_alone(problem, whole.clone(), effect);
        let estimate = &found.fit.estimate;
        let id = estimate.effects[effect].effect.id();
        let probability = probability_of(&weighed, id) * candidate.plausibility();
        let indistinguishable = alternatives(problem, &whole, effect, &weighed);
        let ids = indistinguishable.iter().map(|other| other.effect.id());
        let ids: Vec<&str> = ids.chain([id]).collect();
        let any = probability_of_any(&weighed, &ids) * names.weight(&candidate);
        steps.push(ExplanationStep {
            effect: candidate.effect,
            error_before,
            error_after: fit.error(),
            held_out_before,
            held_out_after,
            confidence: searched.averaged(id, probability),
            presence: any.max(searched.averaged(id, probability)),
            detectability: candidate.detectability,
            explained_share: candidate.explained_share,
            other_forms: other_forms(&found.fit, id, &weighed),
            indistinguishable,
            values: candidate.values().to_vec(),
            intervals: candidate.intervals,
            changed_from: estimate.adopted_as(id).map(|adopted| adopted.size),
            fit,
        });
    }
    steps
}

/// The fit with a subset of the added or changed effects, by their indices.
fn with_some(problem: Problem<'_>, found: &Found, effects: &[usize]) -> Fit {
    let mut estimate = found.fit.estimate.clone();
    for effect in (0..estimate.effects.len()).rev() {
        if !estimate.is_unchanged(effect) && !effects.contains(&effect) {
            estimate = estimate.without(effect);
        }
    }
    match found.refitted.fit_of(&key_of(&estimate)) {
        Some(fit) => fit.clone(),
        None => refine(problem, estimate),
    }
}

/// An effect of a fit weighed against the model with all others.
fn weighed_alone(problem: Problem<'_>, whole: Fit, index: usize) -> Candidate {
    let base = evaluate(problem, whole.estimate.without(index));
    weigh(problem, &base, whole, index)
}

/// Forms of an effect that explain the campaign as well as its own.
fn other_forms(fit: &Fit, id: &str, weighed: &[Weighed]) -> Vec<Option<&'static str>> {
    let own = key_of(&fit.estimate);
    let near = weighed
        .iter()
        .filter(|set| set.relative_likelihood_ratio > -DISTINGUISHABLE);
    near.filter_map(|set| own.form_in_place(set.key, id))
        .collect()
}

/// Confounded alternatives of an effect of a fit, each in its best form.
fn alternatives(
    problem: Problem<'_>,
    whole: &Fit,
    effect: usize,
    weighed: &[Weighed],
) -> Vec<Alternative> {
    let replacement = LazyCell::new(|| Replacement::new(problem, whole, effect));
    let named = whole.estimate.effects[effect].effect.id();
    let own = key_of(&whole.estimate);
    let own: Vec<&str> = own.ids().collect();
    let other = |set: &&Weighed| -> Option<&'static str> {
        let mut others = set.key.ids().filter(|id| !own.contains(id));
        let other = others.next()?;
        let kept = own.iter().filter(|&&id| id != named);
        let same = set.key.len() == own.len()
            && others.next().is_none()
            && kept
                .into_iter()
                .all(|&id| set.key.ids().any(|its| its == id));
        (same && set.relative_likelihood_ratio > -DISTINGUISHABLE).then_some(other)
    };
    let mut alternatives: Vec<Alternative> = weighed
        .iter()
        .filter_map(|set| {
            let id = other(&set)?;
            let effects = &set.fit.estimate.effects;
            let index = effects.iter().position(|added| added.effect.id() == id)?;
            let fit = evaluate(problem, set.fit.estimate.clone());
            let ratio = set.relative_likelihood_ratio;
            Some(Alternative::new(&replacement, fit, index, ratio))
        })
        .collect();
    alternatives.sort_by(|a, b| {
        b.relative_likelihood_ratio
            .total_cmp(&a.relative_likelihood_ratio)
    });
    let mut named: Vec<&str> = Vec::new();
    alternatives.retain(|alternative| {
        let id = alternative.effect.id();
        let is_new = !named.contains(&id);
        named.push(id);
        is_new
    });
    alternatives
}

fn concluded(
    problem: Problem<'_>,
    before: Fit,
    refitted: Option<Fit>,
    searched: Searched,
    members: Members,
) -> Explanation {
    let Problem { experiment, .. } = problem;
    let Members { steps, doubtful } = members;
    let Searched {
        found, corrected, ..
    } = searched;
    let after = found.fit;
    let corrected = corrected.and_then(|fit| CorrectedConstants::new(problem, fit, &after));
    let cells = cells_since(&cells(experiment, &before), experiment, &after);
    let missing = missing_manoeuvre(experiment, &after);
    let verdict = verdict(experiment, &cells, &steps, &after, missing);
    let rest = if verdict == Verdict::Unexplained {
        attribute(experiment, &before, &after)
    } else {
        Attribution::default()
    };
    let next_experiment = match verdict {
        Verdict::Ambiguous if problem.limit.is_over() => None,
        Verdict::Ambiguous => next_experiment(problem, &pairs(&after, &steps)),
        Verdict::NotEnoughData => missing.map(NextExperiment::missing),
        Verdict::Unexplained if !problem.limit.is_over() => {
            Some(exploring(problem, &after, &rest.depends_on))
        }
        Verdict::Unexplained | Verdict::NothingMissing | Verdict::Explained => None,
    };
    let undetected = match verdict {
        _ if problem.limit.is_over() => Vec::new(),
        Verdict::Unexplained => Vec::new(),
        _ => undetected(problem, &after),
    };
    Explanation {
        before,
        refitted,
        corrected,
        after,
        steps,
        doubtful,
        verdict,
        cells,
        rest,
        next_experiment,
        undetected,
        unfinished: found.unfinished,
    }
}

/// Every named effect with each of its confounded alternatives.
fn pairs<'a>(after: &'a Fit, steps: &'a [ExplanationStep]) -> Vec<Pair<'a>> {
    let of_step = |step: &'a ExplanationStep| {
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
    steps: &[ExplanationStep],
    after: &Fit,
    missing: Option<&str>,
) -> Verdict {
    if !enough(after) {
        Verdict::NotEnoughData
    } else if !adequate(experiment, cells, after) {
        Verdict::Unexplained
    } else if steps.is_empty() && missing.is_some() {
        Verdict::NotEnoughData
    } else if steps.is_empty() && after.estimate.constants.is_none() {
        Verdict::NothingMissing
    } else if steps.iter().any(|step| !step.indistinguishable.is_empty()) {
        Verdict::Ambiguous
    } else {
        Verdict::Explained
    }
}

/// Whether there are enough samples to distinguish an effect from noise.
fn enough(fit: &Fit) -> bool {
    fit.weights.count() >= FEWEST_SAMPLES
}

/// The manoeuvre that a campaign lacks to conclude that nothing is missing, if any.
#[must_use]
pub fn missing_manoeuvre(experiment: &Experiment, fit: &Fit) -> Option<&'static str> {
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
