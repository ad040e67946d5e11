//! The effects that deserve a fit: all are screened along finite secants, and the promising ones sketched.

use rayon::prelude::*;

use super::experiment::Experiment;
use super::fit::{Descent, Fit, sketch};
use super::forms::said;
use super::frame::Frame;
use super::jacobian::Jacobian;
use super::scan::{GRIDS, Grid};
use super::scans::Scans;
use super::starts::{Starts, valleys};
use crate::effects::{AddedEffect, Effect};
use crate::model::Model;

/// How many starts of an effect are sketched while the model is far from the data: there are valleys to fall into.
pub(super) const STARTS: usize = 2;

/// Error from which a model counts as far from the data.
pub(super) const FAR: f64 = 1.3;

/// Error from which it may be in a valley of its own, so that a sketch starts coarse. Nearer to the data that leads away
/// from what is right already.
const ASTRAY: f64 = 2.0;

/// A sketch that leaves less than this share of the cost goes first anyway, unless another comes near: other effects with
/// many valleys are looked through for what it leaves.
const ARRIVED: f64 = 0.3;

/// A sketch that leaves no more than this error leaves nothing to those that the screen thinks little of, nor to
/// needles.
const EXPLAINED: f64 = 1.15;

/// An effect is fitted in full if its sketch is the best, or leaves at most this share of what the best sketch explains
/// unexplained.
const HOPELESS: f64 = 0.15;

/// One whose cost hardly fell any more is done: it has to leave at most this share unexplained. What it may fall yet,
/// in falls of its last iteration: of iterations that each bring four fifths of the one before.
const BEATEN: f64 = 0.03;
const STILL_TO_FALL: f64 = 4.0;

/// An effect is sketched if its screened cost leaves at most this share of what the best screened one explains
/// unexplained, unless so many are better: where no effect explains much, all explain nearly as much as the best.
const DOUBTFUL: f64 = 0.6;
const MOST_SKETCHED: usize = 8;

/// Where those do not explain all, it is sketched if it is among the first so many.
const ALWAYS_SKETCHED: usize = 4;

/// Two costs that differ by no more than this may change places in a fit.
pub(super) const CLOSE: f64 = 60.0;

/// An effect roughly fitted.
pub(super) struct Sketch {
    pub effect: &'static dyn Effect,
    /// Where that came to. If it was only screened, nobody knows how far it still falls: infinitely.
    pub found: Descent,
}

impl Sketch {
    /// Whether the screen found nothing of the effect.
    pub fn is_absent(&self) -> bool {
        self.found
            .estimate
            .effects
            .last()
            .is_none_or(AddedEffect::is_null)
    }
}

/// Cost above which an effect is given up, when the best of its kind leaves `best` of `base`: above what leaves `share`
/// of that unexplained.
fn limit(base: f64, best: f64, share: f64) -> f64 {
    best + (share * (base - best)).max(CLOSE)
}

/// Whether a fit from where a sketch came to may leave as little as the best of its kind, which leaves `best` of
/// `base`.
pub(super) fn may_catch_up(sketch: &Descent, base: f64, best: f64) -> bool {
    let limit = |share: f64| limit(base, best, share);
    sketch.cost < limit(HOPELESS) && sketch.cost - STILL_TO_FALL * sketch.falling < limit(BEATEN)
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
        let (refining, own): (Vec<_>, Vec<_>) = effects
            .iter()
            .copied()
            .partition(|effect| refines_any(*effect, effects));
        let screened = self.screened(&own);
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
        if explained {
            self.look_for_plainer(&mut sketches);
        } else {
            self.look_through(&mut sketches);
        }
        self.refine(&mut sketches, &refining);
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

    /// The cost that is left without an effect once what is free has adapted as the screen reckons it.
    fn without(&self) -> f64 {
        self.base.cost.min(self.frame.here())
    }

    /// Whether a sketch leaves next to nothing.
    fn explains(&self, sketch: &Sketch) -> bool {
        let compared = self.base.weights.count() as f64;
        (sketch.found.cost / compared).sqrt() <= EXPLAINED
    }

    /// Looks through the effects whose cost has many valleys, those first where it takes least, until one explains all,
    /// and puts what leads on in place of their sketches.
    fn look_through(&self, sketches: &mut [Sketch]) {
        for grid in GRIDS {
            let Some((leader, least)) = leader(sketches) else {
                return;
            };
            let arrived = least < ARRIVED * self.base.cost;
            let doubtful = limit(self.base.cost, least, DOUBTFUL);
            let near = limit(self.base.cost, least, HOPELESS);
            let looked_for = |sketch: &&mut Sketch| {
                let valleys = valleys(self.experiment, sketch.effect);
                valleys.is_some_and(|valleys| std::ptr::eq(valleys, grid))
                    && (!grid.hinted || sketch.found.cost < doubtful)
                    && (!arrived || sketch.effect.id() == leader.id() || sketch.found.cost < near)
            };
            let explained = sketches
                .par_iter_mut()
                .filter(looked_for)
                .map(|sketch| self.look_for(sketch, grid, doubtful))
                .reduce(|| false, |one, other| one || other);
            if explained {
                return;
            }
        }
    }

    /// Looks through one effect and puts what leads on in place of its sketch; whether that explains all.
    fn look_for(&self, sketch: &mut Sketch, grid: &Grid, doubtful: f64) -> bool {
        let starts = self.looked_through(sketch.effect, grid);
        let other = if starts.cost < doubtful {
            self.sketch(starts)
        } else {
            self.unsketched(starts)
        };
        let explains = self.explains(&other);
        if other.found.cost < sketch.found.cost {
            *sketch = other;
        }
        explains
    }

    /// Looks through those forms of the leading effect that say less than what leads. A form that says more may come
    /// near from where secants miss the valley of a plainer one.
    fn look_for_plainer(&self, sketches: &mut [Sketch]) {
        let Some((leader, _)) = leader(sketches) else {
            return;
        };
        for sketch in sketches {
            let form = sketch.effect;
            if form.id() == leader.id()
                && said(form) < said(leader)
                && let Some(grid) = valleys(self.experiment, form)
            {
                self.look_for(sketch, grid, self.base.cost);
            }
        }
    }

    /// Adds what forms that say more of their effect make of what its usual form found, where that may be the best.
    fn refine(&self, sketches: &mut Vec<Sketch>, refining: &[&'static dyn Effect]) {
        let best = leader(sketches).map_or(self.base.cost, |(_, least)| least);
        let hopeless = limit(self.base.cost, best, HOPELESS);
        let refined = refining.par_iter().map(|&effect| {
            let same = |sketch: &&Sketch| sketch.effect.id() == effect.id() && !sketch.is_absent();
            let usual = sketches.iter().filter(same).map(|sketch| &sketch.found);
            let usual = usual.min_by(|a, b| a.cost.total_cmp(&b.cost));
            let worthwhile = |usual: &&Descent| {
                usual.cost < hopeless && self.without() - usual.cost > self.worthwhile
            };
            usual
                .filter(worthwhile)
                .map_or_else(|| self.absent(effect), |usual| self.refined(usual, effect))
        });
        let refined: Vec<Sketch> = refined.collect();
        sketches.extend(refined);
    }

    /// What a form makes of what another one of its effect found.
    fn refined(&self, usual: &Descent, effect: &'static dyn Effect) -> Sketch {
        let mut start = usual.estimate.clone();
        if let Some(last) = start.effects.last_mut() {
            *last = last.in_form(effect);
        }
        let weights = &self.base.weights;
        Sketch {
            effect,
            found: sketch(self.experiment, self.model, weights, start, false),
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
        if self.without() - starts.cost <= self.worthwhile {
            return self.unsketched(starts);
        }
        Sketch {
            effect: starts.effect,
            found: self.sketch_starts(starts),
        }
    }

    /// What the screen found of an effect as it is.
    fn unsketched(&self, mut starts: Starts) -> Sketch {
        let effect = starts.effect;
        if self.without() - starts.cost <= self.worthwhile || starts.ranked.is_empty() {
            return self.absent(effect);
        }
        Sketch {
            effect,
            found: Descent {
                estimate: starts.ranked.swap_remove(0).estimate,
                cost: starts.cost,
                falling: f64::INFINITY,
            },
        }
    }

    /// Nothing of an effect.
    fn absent(&self, effect: &'static dyn Effect) -> Sketch {
        let mut without = self.base.estimate.clone();
        without.effects.push(AddedEffect::null(effect));
        Sketch {
            effect,
            found: Descent {
                estimate: without,
                cost: self.base.cost,
                falling: 0.0,
            },
        }
    }

    /// Sketches from one start, and from the next where the first leads no lower than that one begins; returns the best.
    fn sketch_starts(&self, starts: Starts) -> Descent {
        let base = self.base;
        let far = base.error() > FAR;
        // Starts that were looked for one by one lie in their valley: a coarse fit would lead away from it.
        let coarse = base.error() > ASTRAY && !starts.looked_through;
        let mut best: Option<Descent> = None;
        for start in starts.ranked.into_iter().take(if far { STARTS } else { 1 }) {
            if best.as_ref().is_some_and(|best| best.cost < start.cost) {
                break;
            }
            let (experiment, weights) = (self.experiment, &base.weights);
            let found = sketch(experiment, self.model, weights, start.estimate, coarse);
            if best.as_ref().is_none_or(|best| found.cost < best.cost) {
                best = Some(found);
            }
        }
        best.expect("there is a start at least")
    }
}

/// Whether an effect refines another of some.
fn refines_any(effect: &dyn Effect, others: &[&'static dyn Effect]) -> bool {
    let usual = |other: &&dyn Effect| other.id() == effect.id() && !other.refines();
    effect.refines() && others.iter().any(|other| usual(&(*other as &dyn Effect)))
}

/// The effect whose sketch leaves the least cost, and that.
fn leader(sketches: &[Sketch]) -> Option<(&'static dyn Effect, f64)> {
    let costs = sketches.iter().map(|s| (s.effect, s.found.cost));
    costs.min_by(|a, b| a.1.total_cmp(&b.1))
}

/// The best first.
fn sort(sketches: &mut [Sketch]) {
    sketches.sort_by(|a, b| a.found.cost.total_cmp(&b.found.cost));
}
