//! Which set of effects a campaign asks for, found as a whole.
//!
//! 1. Dictionary: every way in which the model may be wrong is simulated at a few sizes around the present fit.
//! 2. Best subset: in the linear space of those columns, nuisances projected out, the best subsets of each size are
//!    found without a simulation.
//! 3. Refit: the most promising ones are fitted with the full model and judged by what they leave and by the price of
//!    what they say. Around the best of them a new dictionary is made, until the set stays.
//! 4. Posterior: the weights of all sets that were refitted give the probability of each effect.
//!
//! A forward search takes the best single effect first, which may stand for two others, and needs rules to get rid of
//! it again. A subset is judged with all its members at once.

mod best;
mod dictionary;
mod ends;
mod entry;
mod gram;
mod late;
mod limits;
pub(super) mod posterior;
mod price;
mod promise;
mod refit;
mod screen;
pub mod single;

use std::time::Instant;

use super::clocks::{Clocks, OFFSET_PRIOR_S};
use super::experiment::Experiment;
use super::explain::{Progress, showing};
use super::fit::{Fit, evaluate};
use super::holdout::{HeldOut, held_out};
use super::scans::Scans;
use crate::model::Model;
use dictionary::{Around, Dictionary};
use posterior::{Refitted, key};
use price::Price;
use promise::starts;
use refit::Refits;
use screen::EXPLAINED;

/// Most dictionaries that are made.
const ROUNDS: usize = 6;

/// Sets that are tried on held-out runs in one round.
const TRIED: usize = 3;

/// What a search may do.
#[derive(Debug, Clone, Copy)]
pub struct Options {
    /// Whether effects that the model had before the search may have changed.
    pub changes: bool,
    /// When the search has to end with what it has.
    pub deadline: Option<Instant>,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            changes: true,
            deadline: None,
        }
    }
}

impl Options {
    /// Whether the time is up.
    #[must_use]
    pub fn is_over(&self) -> bool {
        self.deadline
            .is_some_and(|deadline| Instant::now() >= deadline)
    }
}

/// What a search came to.
pub(super) struct Found {
    /// The best fit.
    pub fit: Fit,
    /// What it leaves in held-out runs.
    pub held_out: HeldOut,
    /// All sets that were fitted in full.
    pub refitted: Refitted,
    /// The effects of the best fit, by their indices, those first that explain most beside the ones before.
    pub order: Vec<usize>,
    /// Whether the time was up before the set stayed.
    pub unfinished: bool,
}

impl Found {
    /// Nothing beyond the model.
    pub fn nothing(base: &Fit) -> Self {
        Self {
            fit: base.clone(),
            held_out: HeldOut::NONE,
            refitted: Refitted::new(base),
            order: Vec::new(),
            unfinished: false,
        }
    }
}

/// The set of effects that explains a campaign best, from a fit of the model without any.
pub(super) fn search(
    experiment: &Experiment,
    model: &Model,
    base: &Fit,
    options: Options,
    progress: Progress,
) -> Found {
    let scans = Scans::default();
    let mut refitted = Refitted::new(base);
    let mut present = base.clone();
    let mut left = held_out(experiment, model, base);
    let mut order = Vec::new();
    let mut unfinished = true;
    for _ in 0..ROUNDS {
        if options.is_over() {
            break;
        }
        let name = key(&present).name();
        progress(&format!("what is missing beside {name}"));
        let synchronous = synchronous(experiment, model, &present);
        for (turn, center) in [Some(&present), synchronous.as_ref()]
            .into_iter()
            .flatten()
            .enumerate()
        {
            let around = Around {
                experiment,
                model,
                present: center,
                effects: showing(experiment, model, &center.estimate),
                changes: options.changes,
                scans: &scans,
                worthwhile: 0.5 * Price::beside(experiment, center).of_nothing(),
            };
            let dictionary = around.dictionary();
            if turn == 0 {
                order = in_order(&dictionary);
            }
            let starts = starts(experiment, &dictionary, center, model, &refitted);
            let refits = Refits {
                experiment,
                model,
                present: center,
                price: starts.price,
                options,
            };
            for fit in refits.of(starts.estimates, &refitted, progress) {
                if limits::is_told(experiment, &fit.estimate) {
                    refitted.insert(fit);
                }
            }
        }
        let better = refitted.better(experiment, model, &present);
        let admitted = better.into_iter().take(TRIED).find_map(|fit| {
            let its = held_out(experiment, model, fit);
            let fewer = key(fit).len() < key(&present).len();
            let gain = left.excess() - its.excess();
            // A campaign of one run has no held-out runs; it is not held against what explains it.
            (fewer || gain.is_nan() || gain > 0.0).then(|| (fit.clone(), its))
        });
        let Some((fit, its)) = admitted else {
            unfinished = options.is_over();
            break;
        };
        order = (base.estimate.effects.len()..fit.estimate.effects.len()).collect();
        (present, left) = (fit, its);
    }
    let effects = 0..present.estimate.effects.len();
    let missing = effects.filter(|&effect| !present.estimate.is_unchanged(effect));
    let missing: Vec<usize> = missing.filter(|effect| !order.contains(effect)).collect();
    order.extend(missing);
    Found {
        fit: present,
        held_out: left,
        refitted,
        order,
        unfinished,
    }
}

/// A fit with its clocks in step, if they are off and it leaves more than noise: what is missing may be late, and while
/// clocks stand in for that no secant shows it.
fn synchronous(experiment: &Experiment, model: &Model, fit: &Fit) -> Option<Fit> {
    let offsets_s = fit.estimate.clocks.offsets_s;
    let off = offsets_s
        .iter()
        .any(|offset_s| offset_s.abs() > OFFSET_PRIOR_S);
    (off && fit.error() > EXPLAINED).then(|| {
        let mut estimate = fit.estimate.clone();
        estimate.clocks = Clocks::default();
        evaluate(experiment, model, estimate)
    })
}

/// The effects that are there, those first that explain most beside the ones before.
fn in_order(dictionary: &Dictionary) -> Vec<usize> {
    use best::fitted;
    use entry::Kind;
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
