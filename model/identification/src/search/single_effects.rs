//! Effects tried one at a time on a fitted model.

use hitch_plant::{AddedEffect, Effect, is_same};

use crate::data::problem::Problem;
use crate::estimate::Estimate;
use crate::estimation::fit::{Fit, evaluate_weighted};
use crate::parallel;
use crate::search::best_subset::fitted;
use crate::search::candidates::Progress;
use crate::search::coarse_view::Coarse;
use crate::search::dictionary::DictionaryBuilder;
use crate::search::dictionary_entry::Kind;
use crate::search::options::Options;
use crate::search::promising_subsets::most_starts;
use crate::search::refit::Refits;
use crate::selection::candidate::{Candidate, slow_columns, weigh, weigh_by};
use crate::selection::complexity_penalty::Penalty;
use crate::selection::evidence::shares;

/// Number of the most promising forms that are fitted; the others are weighed at the start of their fit.
const FITTED: usize = 12;

/// Least share of the best predicted cost reduction at which a form gets a full fit; the others get a short one.
const CONSIDERABLE: f64 = 0.1;

/// Callback with each form of an effect once it is weighed.
pub type OnWeighed<'a> = &'a (dyn Fn(&Candidate) + Sync);

/// Each effect in its best form added to a fit and weighed, by decreasing probability.
#[must_use]
pub fn try_effects(
    problem: Problem<'_>,
    base: &Fit,
    effects: &[&'static dyn Effect],
    progress: Progress,
) -> Vec<Candidate> {
    try_each(problem, base, effects, progress, &|_| {})
}

/// An effect with the starts of its fit.
struct Tried {
    effect: &'static dyn Effect,
    /// Predicted cost of the first start.
    cost: f64,
    starts: Vec<Estimate>,
}

/// [`try_effects`] with a callback for each form once it is weighed, in any order.
#[must_use]
pub fn try_each(
    problem: Problem<'_>,
    base: &Fit,
    effects: &[&'static dyn Effect],
    progress: Progress,
    weighed: OnWeighed,
) -> Vec<Candidate> {
    let Problem { experiment, .. } = problem;
    let penalty = Penalty::given(experiment, base);
    let coarse = Coarse::new(problem, base);
    let builder = DictionaryBuilder {
        coarse: &coarse,
        effects: effects.to_vec(),
        changes: false,
        worthwhile: 0.5 * penalty.minimum(),
        limit: problem.limit,
    };
    let dictionary = builder.thorough(builder.dictionary());
    let (gram, entries) = (&dictionary.gram, dictionary.entries.as_slice());
    // The most promising first; as many as a search tries.
    let starts = |effect: &'static dyn Effect| -> Vec<(f64, Estimate)> {
        let own = |&column: &usize| {
            let entry = &entries[column];
            entry.kind == Kind::New && is_same(entry.added.effect, effect)
        };
        let columns = (0..entries.len()).filter(own);
        let start = |column: usize| {
            let subset = fitted(gram, entries, vec![column]);
            let added = entries[column].at(subset.shares[0]);
            let mut estimate = base.estimate.clone();
            estimate.effects.push(added.clone());
            (!added.is_null()).then_some((subset.cost, estimate))
        };
        let mut starts: Vec<(f64, Estimate)> = columns.filter_map(start).collect();
        starts.sort_by(|a, b| a.0.total_cmp(&b.0));
        starts.truncate(most_starts(effect));
        starts
    };
    let mut tried: Vec<Tried> = effects
        .iter()
        .map(|&effect| {
            let starts = starts(effect);
            Tried {
                effect,
                cost: starts.first().map_or(f64::INFINITY, |start| start.0),
                starts: starts.into_iter().map(|(_, start)| start).collect(),
            }
        })
        .collect();
    tried.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    let refits = Refits {
        coarse: &coarse,
        best: coarse.seen.cost,
        penalty,
        options: Options::default(),
    };
    let least = tried.first().map_or(coarse.seen.cost, |tried| tried.cost);
    let considerable = coarse.seen.cost - CONSIDERABLE * (coarse.seen.cost - least);
    let slow = slow_columns(problem, base);
    // Index of the added effect.
    let added = base.estimate.effects.len();
    let promising = |cost: f64| coarse.seen.cost - cost > builder.worthwhile || effects.len() == 1;
    let tried = parallel::map(tried.into_iter().enumerate(), |(rank, tried)| {
        let Tried {
            effect,
            cost,
            starts,
        } = tried;
        progress(effect.id());
        let first = starts.first().cloned().filter(|_| promising(cost));
        let candidate = match first {
            Some(_) if rank < FITTED && cost <= considerable => {
                let fits = parallel::map(starts, |start| refits.one(start)).into_iter();
                let best = fits.min_by(|a, b| a.cost.total_cmp(&b.cost));
                weigh(problem, base, best.unwrap_or_else(|| base.clone()), added)
            }
            Some(estimate) if rank < FITTED => {
                weigh_by(problem, base, refits.one_roughly(estimate), added, &slow)
            }
            Some(estimate) => {
                let fit = evaluate_weighted(problem, estimate, base.weights.clone());
                weigh_by(problem, base, fit, added, &slow)
            }
            None => {
                let mut fit = base.clone();
                fit.estimate.effects.push(AddedEffect::null(effect));
                Candidate::absent(fit, added)
            }
        };
        weighed(&candidate);
        candidate
    });
    likeliest_forms(tried)
}

/// Probability of each candidate among all candidates and none, times the probability that it is the named effect
/// rather than an unknown one.
#[must_use]
pub fn confidences(candidates: &[Candidate]) -> Vec<f64> {
    let none = 0.0;
    let odds = candidates.iter().map(Candidate::log_odds);
    let odds: Vec<f64> = odds.chain([none]).collect();
    let mut confidences = shares(&odds);
    confidences.truncate(candidates.len());
    for (confidence, candidate) in confidences.iter_mut().zip(candidates) {
        *confidence *= candidate.plausibility();
    }
    confidences
}

/// The most probable form of each effect, by decreasing probability.
fn likeliest_forms(mut candidates: Vec<Candidate>) -> Vec<Candidate> {
    candidates.sort_by(|a, b| b.log_odds().total_cmp(&a.log_odds()));
    let mut forms: Vec<Candidate> = Vec::new();
    for candidate in candidates {
        if forms
            .iter()
            .all(|form| form.effect.id() != candidate.effect.id())
        {
            forms.push(candidate);
        }
    }
    forms
}
