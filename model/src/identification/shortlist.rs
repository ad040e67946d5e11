//! The effects that deserve a fit: all are screened along finite secants, and the promising ones sketched.

use rayon::prelude::*;

use super::estimate::Estimate;
use super::experiment::Experiment;
use super::fit::{Fit, sketch};
use super::frame::Frame;
use super::jacobian::Jacobian;
use super::scan::GRIDS;
use super::scans::Scans;
use super::starts::{Starts, valleys};
use crate::effects::{AddedEffect, Effect};
use crate::model::Model;

/// How many starts of an effect are sketched while the model is far from the data: there are valleys to fall into.
pub(super) const STARTS: usize = 2;

/// Error from which a model counts as far from the data.
pub(super) const FAR: f64 = 1.3;

/// A sketch that leaves less than this share of the cost needs no second start.
const ARRIVED: f64 = 0.3;

/// A sketch that leaves no more than this error leaves nothing to those that the screen thinks little of, nor to
/// needles.
const EXPLAINED: f64 = 1.15;

/// An effect is fitted in full if its sketch is the best, or leaves at most this share of what the best sketch explains
/// unexplained.
pub(super) const HOPELESS: f64 = 0.15;

/// An effect is sketched if its screened cost leaves at most this share of what the best screened one explains
/// unexplained, unless so many are better: where no effect explains much, all explain nearly as much as the best.
const DOUBTFUL: f64 = 0.6;
const MOST_SKETCHED: usize = 8;

/// Where those do not explain all, it is sketched if it is among the first so many.
const ALWAYS_SKETCHED: usize = 4;

/// Two costs that differ by no more than this may change places in a fit.
const CLOSE: f64 = 60.0;

/// An effect roughly fitted.
pub(super) struct Sketch {
    pub effect: &'static dyn Effect,
    pub cost: f64,
    pub estimate: Estimate,
}

impl Sketch {
    /// Whether the screen found nothing of the effect.
    pub fn is_absent(&self) -> bool {
        self.estimate
            .effects
            .last()
            .is_none_or(AddedEffect::is_null)
    }
}

/// Cost above which an effect is given up, when the best of its kind leaves `best` of `base`: above what leaves `share`
/// of that unexplained.
pub(super) fn limit(base: f64, best: f64, share: f64) -> f64 {
    best + (share * (base - best)).max(CLOSE)
}

/// What effects are looked for on.
pub(super) struct Shortlist<'a> {
    pub experiment: &'a Experiment,
    pub model: &'a Model,
    pub base: &'a Fit,
    /// What is free at the base, and adapts to an effect.
    pub frame: Frame<&'a Jacobian>,
    /// Fall of the cost under which nothing is worth a sketch.
    pub worthwhile: f64,
    /// Fine searches of the rounds before.
    pub scans: &'a Scans,
}

impl Shortlist<'_> {
    /// Every effect, sketched if it has a chance, the best first.
    pub fn sketches(&self, effects: &[&'static dyn Effect]) -> Vec<Sketch> {
        let screened = self.screened(effects);
        let best = screened.first().map_or(self.base.cost, |first| first.cost);
        let doubtful = limit(self.base.cost, best, DOUBTFUL);
        let promising = screened.partition_point(|starts| starts.cost < doubtful);
        let promising = promising.min(MOST_SKETCHED);
        let mut others = screened.into_iter();
        let mut sketches = self.sketched(others.by_ref().take(promising).collect());
        let explained = sketches.iter().any(|sketch| self.explains(sketch));
        if !explained {
            let rest = ALWAYS_SKETCHED.saturating_sub(promising);
            sketches.extend(self.sketched(others.by_ref().take(rest).collect()));
        }
        sketches.extend(others.map(|starts| self.unsketched(starts)));
        if !explained {
            self.look_through(&mut sketches);
        }
        sort(&mut sketches);
        sketches
    }

    /// Screens effects by finite secants, the most promising first.
    fn screened(&self, effects: &[&'static dyn Effect]) -> Vec<Starts> {
        let mut screened: Vec<Starts> = effects
            .par_iter()
            .map(|&effect| self.starts(effect))
            .collect();
        screened.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        screened
    }

    /// Whether a sketch leaves next to nothing.
    fn explains(&self, sketch: &Sketch) -> bool {
        let compared = self.base.weights.count() as f64;
        (sketch.cost / compared).sqrt() <= EXPLAINED
    }

    /// Looks through the effects whose cost has many valleys, those first where it takes least, until one explains all,
    /// and puts what leads on in place of their sketches.
    fn look_through(&self, sketches: &mut [Sketch]) {
        for grid in GRIDS {
            let best = sketches.iter().map(|sketch| sketch.cost);
            let doubtful = limit(self.base.cost, best.fold(self.base.cost, f64::min), DOUBTFUL);
            let looked_for = |sketch: &&mut Sketch| {
                let valleys = valleys(self.experiment, sketch.effect);
                valleys.is_some_and(|valleys| std::ptr::eq(valleys, grid))
                    && (!grid.hinted || sketch.cost < doubtful)
            };
            let explained = sketches
                .par_iter_mut()
                .filter(looked_for)
                .map(|sketch| {
                    let found = self.sketch(self.looked_through(sketch.effect, grid));
                    let explains = self.explains(&found);
                    if found.cost < sketch.cost {
                        *sketch = found;
                    }
                    explains
                })
                .reduce(|| false, |one, other| one || other);
            if explained {
                return;
            }
        }
    }

    fn sketched(&self, screened: Vec<Starts>) -> Vec<Sketch> {
        screened
            .into_par_iter()
            .map(|starts| self.sketch(starts))
            .collect()
    }

    /// Sketches an effect if the screen found anything of it.
    fn sketch(&self, starts: Starts) -> Sketch {
        if self.base.cost - starts.cost <= self.worthwhile {
            return self.unsketched(starts);
        }
        let effect = starts.effect;
        let (cost, estimate) = self.sketch_starts(starts);
        Sketch {
            effect,
            cost,
            estimate,
        }
    }

    /// What the screen found of an effect as it is.
    fn unsketched(&self, mut starts: Starts) -> Sketch {
        let effect = starts.effect;
        if self.base.cost - starts.cost > self.worthwhile && !starts.estimates.is_empty() {
            return Sketch {
                effect,
                cost: starts.cost,
                estimate: starts.estimates.swap_remove(0),
            };
        }
        let mut without = self.base.estimate.clone();
        without.effects.push(AddedEffect::null(effect));
        Sketch {
            effect,
            cost: self.base.cost,
            estimate: without,
        }
    }

    /// Sketches from one start, and from the next where the first leads nowhere; returns the best cost and estimate.
    fn sketch_starts(&self, starts: Starts) -> (f64, Estimate) {
        let base = self.base;
        let far = base.error() > FAR;
        // Starts that were looked for one by one lie in their valley: a coarse fit would lead away from it.
        let coarse = far && !starts.looked_through;
        let mut best = (base.cost, base.estimate.clone());
        let starts = starts.estimates.into_iter();
        for start in starts.take(if far { STARTS } else { 1 }) {
            let (experiment, weights) = (self.experiment, &base.weights);
            let found = sketch(experiment, self.model, weights, start, coarse);
            if best.1.effects.len() < found.1.effects.len() || found.0 < best.0 {
                best = found;
            }
            if best.0 < ARRIVED * base.cost {
                break;
            }
        }
        best
    }
}

/// The best first.
fn sort(sketches: &mut [Sketch]) {
    sketches.sort_by(|a, b| a.cost.total_cmp(&b.cost));
}
