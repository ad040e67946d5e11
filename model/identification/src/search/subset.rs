//! Search for the set of effects that explains a campaign.
//!
//! 1. Dictionary: candidate changes of the model are simulated at a few sizes around the present fit.
//! 2. Best subset: in the linear span of those columns, with nuisance parameters projected out, the best subsets of
//!    each size are found without a simulation.
//! 3. Refit: the most promising subsets are fitted with the full model and compared by their penalised cost. A new
//!    dictionary is built around the best of them, until the set no longer changes.
//! 4. Posterior: the weights of all refitted sets give the probability of each effect.
//!
//! A forward search would take the best single effect first, which may stand in for two others, and would need rules to
//! remove it again. A subset is judged with all its members at once.

use std::collections::BTreeMap;

use hitch_plant::{Effect, ParameterKind};

use crate::data::clocks::Clocks;
use crate::data::limit::Limit;
use crate::data::problem::Problem;
use crate::estimation::fit::{Fit, evaluate, evaluate_weighted, refine};
use crate::parallel;
use crate::search::candidates::{Progress, showing};
use crate::search::coarse_view::Coarse;
use crate::search::confounded::confounded;
use crate::search::dictionary::{Dictionary, DictionaryBuilder};
use crate::search::options::Options;
use crate::search::promising_subsets::starts;
use crate::search::refit::Refits;
use crate::search::resolution;
use crate::search::screening::EXPLAINED;
use crate::selection::complexity_penalty::Penalty;
use crate::selection::hold_out::{HeldOut, held_out};
use crate::selection::posterior::{Refitted, key, probability_of};

/// Most dictionaries of a search.
const ROUNDS: usize = 6;

/// Most effects that one dictionary may add to the present set.
const MORE: usize = 2;

/// Largest error, in sigma, of the model without an effect at which a switching effect can be confounded with another
/// one. Above it, the switching instants distinguish them.
const CONFOUNDABLE_ERROR: f64 = 1.5;

/// A fit with fewer effects is slightly worse than the present one if its cost is below this multiple of that one's.
pub(crate) const FAINT: f64 = 1.5;

/// Sets per round that are evaluated on held-out runs.
const TRIED: usize = 3;

/// The result of a search.
pub(crate) struct Found {
    /// The best fit.
    pub fit: Fit,
    /// Its error in held-out runs.
    pub held_out: HeldOut,
    /// All sets that were fitted in full.
    pub refitted: Refitted,
    /// Indices of the effects of the best fit, in greedy order of the cost reduction that each adds.
    pub order: Vec<usize>,
    /// Whether the deadline passed before the set stopped changing.
    pub unfinished: bool,
}

impl Found {
    /// The model alone.
    pub fn nothing(base: &Fit) -> Self {
        Self {
            fit: base.clone(),
            held_out: HeldOut::NONE,
            refitted: Refitted::new(base),
            order: Vec::new(),
            unfinished: false,
        }
    }

    /// Removes the effect at a place of the order, and fits the others again.
    pub fn remove(&mut self, problem: Problem<'_>, place: usize) {
        let effect = self.order.remove(place);
        let reduced = self.fit.estimate.without(effect);
        let removed = reduced.effects.len() < self.fit.estimate.effects.len();
        self.fit = refine(problem, reduced);
        self.held_out = held_out(problem, &self.fit);
        for other in &mut self.order {
            *other -= usize::from(removed && *other > effect);
        }
    }

    /// Fits without each of its effects.
    pub fn without_each(&self, problem: Problem<'_>) -> Vec<Fit> {
        let without = |&effect: &usize| refine(problem, self.fit.estimate.without(effect));
        parallel::map(&self.order, without)
    }

    /// Moves to the best of the sets that were fitted, with fits of subsets of its effects, if that is better and has fewer
    /// effects. Returns whether there is one: a fit of all effects may have ended in a local minimum that a fit of fewer
    /// leaves.
    pub fn moves_to_fewer(&mut self, problem: Problem<'_>, subsets: Vec<Fit>) -> bool {
        for fit in subsets {
            self.refitted.insert(fit);
        }
        let own = key(&self.fit).len();
        let better = self.refitted.better(problem, &self.fit);
        let Some(fit) = better.into_iter().find(|fit| key(fit).len() < own).cloned() else {
            return false;
        };
        self.order = fit.estimate.changed().collect();
        self.held_out = held_out(problem, &fit);
        self.fit = fit;
        true
    }

    /// Posterior probabilities of the effects that any fitted set has.
    pub fn probabilities(&self, problem: Problem<'_>) -> BTreeMap<&'static str, f64> {
        let weighed = self.refitted.weighed(problem, &self.fit);
        let ids = weighed.iter().flat_map(|set| set.key.ids());
        ids.map(|id| (id, probability_of(&weighed, id))).collect()
    }
}

/// A search for the set of effects that explains a campaign best.
pub(crate) struct Search<'a> {
    /// The measured data and the model.
    problem: Problem<'a>,
    options: Options<'a>,
    progress: Progress<'a>,
    refitted: Refitted,
    /// The best fit so far, and its error in held-out runs.
    present: Fit,
    left: HeldOut,
    /// Indices of its effects, in greedy order of cost reduction.
    order: Vec<usize>,
    /// Indices of its effects, each with the ids of its confounded alternatives.
    rivals: Vec<(usize, Vec<&'static str>)>,
    /// Rounds made.
    rounds: usize,
    /// Whether the last round found nothing better.
    is_stable: bool,
}

impl<'a> Search<'a> {
    /// A search from a fit of the model alone.
    pub fn new(
        problem: Problem<'a>,
        base: &Fit,
        options: Options<'a>,
        progress: Progress<'a>,
    ) -> Self {
        Self {
            problem,
            options,
            progress,
            refitted: Refitted::new(base),
            present: base.clone(),
            left: held_out(problem, base),
            order: Vec::new(),
            rivals: Vec::new(),
            rounds: 0,
            is_stable: false,
        }
    }

    /// Makes another round, within a deadline. Returns whether there may be more: the round found something better, and
    /// neither the deadline nor the limit of rounds is reached.
    pub fn advance(&mut self, limit: Limit<'a>) -> bool {
        self.options.limit = limit;
        if self.is_stable || self.rounds >= ROUNDS || self.options.is_over() {
            return false;
        }
        if self.extend() || self.tries_alternatives() {
            self.rounds += 1;
            let given = self.problem.model.effects.len();
            self.order = (given..self.present.estimate.effects.len()).collect();
            return true;
        }
        // A round that the deadline cut short says nothing.
        self.is_stable = !self.options.is_over();
        false
    }

    /// Moves to a fit if it is better.
    pub fn consider(&mut self, fit: Fit) {
        self.refitted.insert(fit);
        self.moves_to_best();
    }

    /// The best fit so far.
    pub fn present(&self) -> &Fit {
        &self.present
    }

    /// The best fits with fewer effects, one of each size, whose cost is not much larger: the other effects are faint.
    pub fn slightly_worse_with_fewer(&self) -> Vec<&Fit> {
        self.refitted
            .best_by_size(key(&self.present).len())
            .into_iter()
            .filter(|fit| fit.cost < FAINT * self.present.cost)
            .collect()
    }

    /// Whether the last round found nothing better.
    pub fn is_stable(&self) -> bool {
        self.is_stable
    }
    /// Builds a dictionary around the present fit and moves to the best set that it leads to. Returns whether there is
    /// one.
    fn extend(&mut self) -> bool {
        let name = key(&self.present).name();
        (self.progress)(&format!("what is missing beside {name}"));
        let present = self.present.clone();
        let coarse = Coarse::new(self.problem, &present);
        let builder = self.builder(&coarse, |_| true);
        let dictionary = builder.dictionary();
        self.fits_subsets(&coarse, &dictionary, MORE);
        self.rivals = rivals(&present, &dictionary);
        self.order = in_order(&dictionary);
        // Once an effect has been found, the plain dictionary is sufficient as long as it leads to improvements.
        if key(&present).len() > 0 && self.moves_to_best() {
            return true;
        }
        if self.refitted.least_error() > EXPLAINED {
            let dictionary = self.builder(&coarse, |_| true).thorough(dictionary);
            self.fits_subsets(&coarse, &dictionary, MORE);
            self.tries_synchronised(&present);
        }
        self.moves_to_best()
    }

    /// The dictionary around the present fit with its constants held. To first order, constants without bounds explain as
    /// much as an effect that is confounded with them, so that its alternatives would seem to explain nothing.
    fn beside_held_constants(&self) -> Dictionary {
        let mut held = self.present.clone();
        held.estimate = held.estimate.with_constants_held(true);
        let coarse = Coarse::new(self.problem, &held);
        self.builder(&coarse, |_| true).dictionary()
    }

    /// Repeats the dictionary with all clocks in step, for delays that clock offsets compensate.
    fn tries_synchronised(&mut self, present: &Fit) {
        let in_step = synchronous(self.problem, present);
        if let Some(in_step) = in_step
            && self.refitted.least_error() > EXPLAINED
        {
            let coarse = Coarse::new(self.problem, &in_step);
            let dictionary = self.builder(&coarse, is_delay).dictionary();
            // A set that was fitted with clock offsets may have another local minimum with all clocks in step.
            let known = Refitted::new(present);
            self.fits_subsets_except(&known, &coarse, &dictionary, MORE);
        }
    }

    /// Tries the confounded alternatives of each effect in its place, and moves to one if it is better. Returns whether
    /// there is one. Added beside the effect, an alternative would explain nothing. Free constants are held, see
    /// [`Search::beside_held_constants`].
    fn tries_alternatives(&mut self) -> bool {
        let mut estimate = self.present.estimate.clone();
        if estimate.constants.is_some() {
            estimate = estimate.with_constants_held(true);
            self.rivals = rivals(&self.present, &self.beside_held_constants());
        }
        for (index, rivals) in std::mem::take(&mut self.rivals) {
            if rivals.is_empty() || self.options.is_over() {
                continue;
            }
            let id = estimate.effects[index].effect.id();
            (self.progress)(&format!("what is there in place of {id}"));
            let weights = self.present.weights.clone();
            let without = estimate.without(index);
            let center = evaluate_weighted(self.problem, without, weights);
            let coarse = Coarse::new(self.problem, &center);
            let builder = self.builder(&coarse, |effect| rivals.contains(&effect.id()));
            let dictionary = if center.error() < CONFOUNDABLE_ERROR {
                builder.thorough(builder.dictionary())
            } else {
                builder.dictionary()
            };
            self.fits_subsets(&coarse, &dictionary, 1);
        }
        self.moves_to_best()
    }

    /// The inputs of a dictionary around a fit, with the effects selected by `wanted`.
    fn builder<'b>(
        &'b self,
        coarse: &'b Coarse,
        wanted: impl Fn(&dyn Effect) -> bool,
    ) -> DictionaryBuilder<'b> {
        let mut effects = showing(self.problem, &coarse.present.estimate);
        effects.retain(|effect| wanted(*effect));
        DictionaryBuilder {
            coarse,
            effects,
            changes: self.options.changes,
            worthwhile: 0.5 * Penalty::given(self.problem.experiment, coarse.present).minimum(),
            // The other half is for the fits of the sets that it leads to.
            limit: self.options.limit.after(0.5),
        }
    }

    /// Fits the most promising sets of a dictionary, with at most `more` effects more than its fit.
    fn fits_subsets(&mut self, coarse: &Coarse, dictionary: &Dictionary, more: usize) {
        let known = self.refitted.clone();
        self.fits_subsets_except(&known, coarse, dictionary, more);
    }

    /// The same without the sets in `known`.
    fn fits_subsets_except(
        &mut self,
        known: &Refitted,
        coarse: &Coarse,
        dictionary: &Dictionary,
        more: usize,
    ) {
        let starts = starts(coarse, dictionary, known, more);
        let refits = Refits {
            coarse,
            best: coarse.cost(&self.present) + starts.penalty.of_all(&self.present.estimate),
            penalty: starts.penalty,
            options: self.options,
        };
        for mut fit in refits.of(starts.estimates, &dictionary.jacobian, known, self.progress) {
            fit.estimate = fit.estimate.with_constants_held(false);
            if resolution::is_resolved(self.problem.experiment, &fit.estimate) {
                self.refitted.insert(fit);
            }
        }
    }

    /// Moves to the best set that is better than the present one and has less error in held-out runs. Returns whether
    /// there is one.
    fn moves_to_best(&mut self) -> bool {
        let better = self.refitted.better(self.problem, &self.present);
        let admitted = better.into_iter().take(TRIED).find_map(|fit| {
            let its = held_out(self.problem, fit);
            let fewer = key(fit).len() < key(&self.present).len();
            let gain = self.left.excess() - its.excess();
            // NaN without compared samples; the test is then skipped.
            (fewer || gain.is_nan() || gain > 0.0).then(|| (fit.clone(), its))
        });
        let found = admitted.is_some();
        if let Some((fit, its)) = admitted {
            (self.options.improved)(&fit);
            (self.present, self.left) = (fit, its);
        }
        found
    }

    /// The result so far.
    pub fn found(self) -> Found {
        let present = self.present;
        let mut order = self.order;
        let missing = present.estimate.changed();
        let missing: Vec<usize> = missing.filter(|effect| !order.contains(effect)).collect();
        order.extend(missing);
        Found {
            fit: present,
            held_out: self.left,
            refitted: self.refitted,
            order,
            unfinished: !self.is_stable,
        }
    }
}

/// The effects of a fit, each with the ids of its confounded alternatives.
fn rivals(present: &Fit, dictionary: &Dictionary) -> Vec<(usize, Vec<&'static str>)> {
    let own = present.estimate.changed();
    own.map(|index| (index, confounded(dictionary, index)))
        .collect()
}

/// Whether an effect delays a channel: its size is a time.
fn is_delay(effect: &dyn Effect) -> bool {
    effect.parameters()[0].kind == ParameterKind::Time
}

/// A fit re-evaluated with all clocks in step, if they are off: clock offsets that compensate for a missing delay hide
/// it from the secants.
fn synchronous(problem: Problem<'_>, fit: &Fit) -> Option<Fit> {
    fit.estimate.clocks.are_off().then(|| {
        let mut estimate = fit.estimate.clone();
        estimate.clocks = Clocks::default();
        evaluate(problem, estimate)
    })
}

/// The present effects in greedy order of the cost reduction that each adds.
fn in_order(dictionary: &Dictionary) -> Vec<usize> {
    use crate::search::best_subset::fitted;
    use crate::search::dictionary_entry::Kind;
    let (gram, entries) = (&dictionary.gram, dictionary.entries.as_slice());
    let mut rest: Vec<(usize, usize)> = (0..entries.len())
        .filter_map(|column| match entries[column].kind {
            Kind::Present(effect) => Some((column, effect)),
            Kind::New | Kind::Change(_) => None,
        })
        .collect();
    let (mut taken, mut order) = (Vec::new(), Vec::new());
    while !rest.is_empty() {
        let with = |&(column, _): &(usize, usize)| {
            let mut columns: Vec<usize> = taken.clone();
            columns.push(column);
            fitted(gram, entries, columns).cost
        };
        let costs: Vec<f64> = rest.iter().map(with).collect();
        let best = (0..rest.len()).min_by(|&a, &b| costs[a].total_cmp(&costs[b]));
        let (column, effect) = rest.swap_remove(best.unwrap_or(0));
        taken.push(column);
        order.push(effect);
    }
    order
}
