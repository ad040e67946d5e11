//! Posterior probabilities of the fitted sets of effects.

use std::collections::HashMap;

use crate::data::experiment::Experiment;
use crate::data::problem::Problem;
use crate::estimate::Estimate;
use crate::estimation::fit::Fit;
use crate::selection::complexity_penalty::Penalty;
use crate::selection::evidence::shares;

/// Smallest reduction of the penalised cost that counts as better.
const BETTER: f64 = 1.0;

/// A set of effects: the sorted ids and forms of its members.
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct EffectSet(Vec<(&'static str, Option<&'static str>)>);

impl EffectSet {
    /// The key of some members.
    pub fn new(mut members: Vec<(&'static str, Option<&'static str>)>) -> Self {
        members.sort_unstable();
        Self(members)
    }

    /// Number of members.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// The members' ids.
    pub fn ids(&self) -> impl Iterator<Item = &'static str> {
        self.0.iter().map(|(id, _)| *id)
    }

    /// The members: their ids and forms.
    pub fn members(&self) -> impl Iterator<Item = (&'static str, Option<&'static str>)> {
        self.0.iter().copied()
    }

    /// The form of a member in another key, if that differs from this key only in the form of this member.
    pub fn form_in_place(&self, other: &Self, id: &str) -> Option<Option<&'static str>> {
        let others = |key: &Self| -> Vec<_> { key.members().filter(|own| own.0 != id).collect() };
        let form = |key: &Self| key.members().find(|own| own.0 == id).map(|own| own.1);
        let (own, its) = (form(self)?, form(other)?);
        (own != its && others(self) == others(other)).then_some(its)
    }

    /// Display name: the members' names joined by ` + `.
    pub fn name(&self) -> String {
        let names = self.0.iter().map(|(id, form)| match form {
            Some(form) => format!("{id}/{form}"),
            None => (*id).to_owned(),
        });
        let names: Vec<String> = names.collect();
        if names.is_empty() {
            "the model".to_owned()
        } else {
            names.join(" + ")
        }
    }
}

/// The changes of a fit relative to the model: added effects, and changed adopted ones.
pub(crate) fn key(fit: &Fit) -> EffectSet {
    key_of(&fit.estimate)
}

/// The changes of an estimate relative to the model.
pub(crate) fn key_of(estimate: &Estimate) -> EffectSet {
    let members = estimate.changed().map(|index| {
        let effect = estimate.effects[index].effect;
        (effect.id(), effect.form())
    });
    EffectSet::new(members.collect())
}

/// Sets that were fitted in full, the best fit of each.
#[derive(Debug, Clone)]
pub(crate) struct Refitted {
    fits: HashMap<EffectSet, Fit>,
}

impl Refitted {
    /// Only the model alone.
    pub fn new(base: &Fit) -> Self {
        let fits = HashMap::from([(key(base), base.clone())]);
        Self { fits }
    }

    /// Whether a set was fitted.
    pub fn contains(&self, key: &EffectSet) -> bool {
        self.fits.contains_key(key)
    }

    /// The fit of a set, if it was fitted.
    pub fn fit_of(&self, key: &EffectSet) -> Option<&Fit> {
        self.fits.get(key)
    }

    /// Least error of all sets.
    pub fn least_error(&self) -> f64 {
        let errors = self.fits.values().map(Fit::error);
        errors.fold(f64::INFINITY, f64::min)
    }

    /// Adds a fit, unless a better one of the same set is known.
    pub fn insert(&mut self, fit: Fit) {
        let key = key(&fit);
        let better = self
            .fits
            .get(&key)
            .is_none_or(|known| fit.cost < known.cost);
        if better {
            self.fits.insert(key, fit);
        }
    }

    /// Sets that are better than the present one, by penalised cost.
    pub fn better(&self, problem: Problem<'_>, present: &Fit) -> Vec<&Fit> {
        let penalty = self.penalty(problem.experiment);
        let own = key(present);
        let others = self.fits.iter().filter(|(key, _)| **key != own);
        let mut better: Vec<(f64, &Fit)> = others
            .map(|(_, fit)| (gain(present, fit, penalty), fit))
            .filter(|(gain, _)| *gain > BETTER)
            .collect();
        better.sort_by(|a, b| b.0.total_cmp(&a.0));
        better.into_iter().map(|(_, fit)| fit).collect()
    }

    /// The best fit of each number of effects below `size`.
    pub fn best_by_size(&self, size: usize) -> Vec<&Fit> {
        let best = |count: usize| {
            let same = self.fits.iter().filter(|(key, _)| key.len() == count);
            let fits = same.map(|(_, fit)| fit);
            fits.min_by(|a, b| a.cost.total_cmp(&b.cost))
        };
        (0..size).filter_map(best).collect()
    }

    /// The penalty of effects given the residuals of the best fit.
    fn penalty(&self, experiment: &Experiment) -> Penalty {
        let fits = self.fits.values();
        let least = fits.min_by(|a, b| a.cost.total_cmp(&b.cost));
        Penalty::given(experiment, least.expect("the model alone is there"))
    }

    /// Posterior probability of each set, and its penalised likelihood ratio relative to the best one.
    pub fn weighed(&self, problem: Problem<'_>, best: &Fit) -> Vec<Weighed<'_>> {
        let Problem { experiment, .. } = problem;
        let penalty = Penalty::given(experiment, best);
        let mut weighed: Vec<Weighed> = self
            .fits
            .iter()
            .map(|(key, fit)| Weighed {
                key,
                fit,
                relative_likelihood_ratio: gain(best, fit, penalty) / penalty.unit,
                probability: 0.0,
            })
            .collect();
        // The iteration order of a hash map is random.
        weighed.sort_by(|a, b| a.key.cmp(b.key));
        let odds: Vec<f64> = weighed
            .iter()
            .map(|set| 0.5 * set.relative_likelihood_ratio)
            .collect();
        for (set, share) in weighed.iter_mut().zip(shares(&odds)) {
            set.probability = share;
        }
        weighed
    }
}

/// Probability that an effect is present.
pub(crate) fn probability_of(weighed: &[Weighed<'_>], id: &str) -> f64 {
    probability_of_any(weighed, &[id])
}

/// Probability that any of some effects is present.
pub(crate) fn probability_of_any(weighed: &[Weighed<'_>], ids: &[&str]) -> f64 {
    let has_any = |set: &&Weighed<'_>| set.key.ids().any(|own| ids.contains(&own));
    let with_any = weighed.iter().filter(has_any);
    with_any.map(|set| set.probability).sum()
}

/// A set with its posterior weight.
pub(crate) struct Weighed<'a> {
    pub key: &'a EffectSet,
    pub fit: &'a Fit,
    /// Penalised likelihood ratio relative to the best set; negative if worse.
    pub relative_likelihood_ratio: f64,
    pub probability: f64,
}

/// By how much the penalised cost of a fit is below that of another one, under common weights.
fn gain(from: &Fit, to: &Fit, penalty: Penalty) -> f64 {
    let [before, after] = from.compared(to);
    before + penalty.of_all(&from.estimate) - after - penalty.of_all(&to.estimate)
}
