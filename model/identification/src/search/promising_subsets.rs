//! Selection of the subsets that are fitted with the full model.

use hitch_plant::{Effect, Model};

use crate::estimate::Estimate;
use crate::estimation::fit::Fit;
use crate::search::best_subset::{MOST, Subset, best_subsets, fitted};
use crate::search::coarse_view::Coarse;
use crate::search::dictionary::Dictionary;
use crate::search::dictionary_entry::{Entry, with_entries};
use crate::selection::complexity_penalty::Penalty;
use crate::selection::posterior::{EffectSet, Refitted, key};

/// Subsets of each size that are ranked, and subsets in total that are fitted.
const RANKED: usize = 40;
const FITTED: usize = 12;

/// Starts of one set of effects whose cost has many local minima.
const LOCAL_MINIMA: usize = 2;

/// Most starts of a set with an effect.
pub(crate) fn most_starts(effect: &dyn Effect) -> usize {
    if effect.size_response().is_rough() {
        LOCAL_MINIMA
    } else {
        1
    }
}

/// A subset is fitted if its cost exceeds the best one by at most this share of what the two do not have in common, or
/// by at most this likelihood ratio.
pub(crate) const NEAR: f64 = 0.15;
pub(crate) const CLOSE: f64 = 60.0;

/// Starts of fits, and the penalty of effects given the residuals that the dictionary predicts.
pub(crate) struct Starts {
    pub estimates: Vec<Estimate>,
    pub penalty: Penalty,
}

/// Starts of the subsets whose predicted cost is least or close to it, that were not fitted yet, and that have at most
/// `more` effects more than the present ones.
pub(crate) fn starts(
    coarse: &Coarse,
    dictionary: &Dictionary,
    refitted: &Refitted,
    more: usize,
) -> Starts {
    let Coarse {
        problem,
        present,
        few,
        seen,
        ..
    } = coarse;
    let own = key(present);
    let largest = (own.len() + more).min(MOST);
    let sizes = best_subsets(&dictionary.gram, &dictionary.entries, largest);
    let firsts = sizes.iter().filter_map(|subsets| subsets.first());
    let lowest = firsts.min_by(|a, b| a.cost.total_cmp(&b.cost));
    let lowest = lowest.expect("the empty subset is there");
    let left = dictionary.left(lowest);
    let variance = lowest.cost / seen.weights.count() as f64;
    let penalty = Penalty::new(few, present.weights.count(), variance, &left);
    let predicted_cost = |subset: &Subset| {
        let members = subset.columns.iter();
        let members = members.map(|&column| &dictionary.entries[column]);
        let prices = members.map(|entry| penalty.of(&entry.added, entry.parameters()));
        subset.cost + prices.sum::<f64>()
    };
    let candidates = sizes.iter().flat_map(|subsets| subsets.iter().take(RANKED));
    let mut ranked: Vec<(f64, &Subset)> = candidates
        .map(|subset| (predicted_cost(subset), subset))
        .collect();
    ranked.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (best, leader) = ranked[0];
    let close = CLOSE * penalty.unit;
    let mut taken: Vec<EffectSet> = vec![own];
    let mut estimates = Vec::new();
    for (predicted_cost, subset) in ranked {
        let near = best + (NEAR * apart(dictionary, subset, leader)).max(close);
        let key = key_of(dictionary, subset);
        let known = taken.iter().filter(|taken| **taken == key).count();
        let members = subset.columns.iter();
        let effects = members.map(|&column| dictionary.entries[column].added.effect);
        let most = effects.map(most_starts).max().unwrap_or(1);
        if predicted_cost > near || is_more(subset, leader) || known >= most {
            continue;
        }
        let starts = |&column: &usize| dictionary.is_start(column);
        if !refitted.contains(&key) && subset.columns.iter().all(starts) {
            estimates.push(start(dictionary, present, problem.model, subset));
        }
        taken.push(key);
        if taken.len() > FITTED {
            break;
        }
    }
    Starts { estimates, penalty }
}

/// Cost reduction of the leading subset beyond that of its intersection with another.
fn apart(dictionary: &Dictionary, subset: &Subset, leader: &Subset) -> f64 {
    let common = subset.columns.iter().copied();
    let common = common
        .filter(|column| leader.columns.contains(column))
        .collect();
    fitted(&dictionary.gram, &dictionary.entries, common).cost - leader.cost
}

/// Whether a subset is a proper superset of another.
fn is_more(subset: &Subset, other: &Subset) -> bool {
    let has = |column: &usize| subset.columns.contains(column);
    subset.columns.len() > other.columns.len() && other.columns.iter().all(has)
}

fn start(dictionary: &Dictionary, present: &Fit, model: &Model, subset: &Subset) -> Estimate {
    let members = subset.columns.iter().zip(&subset.shares);
    let members: Vec<(&Entry, f64)> = members
        .map(|(&column, &share)| {
            let entry = &dictionary.entries[column];
            (entry, entry.start(share))
        })
        .collect();
    with_entries(&present.estimate, &model.effects, &members)
}

fn key_of(dictionary: &Dictionary, subset: &Subset) -> EffectSet {
    let members = subset.columns.iter().map(|&column| {
        let effect = dictionary.entries[column].added.effect;
        (effect.id(), effect.form())
    });
    EffectSet::new(members.collect())
}
