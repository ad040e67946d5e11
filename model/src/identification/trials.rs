//! Effects tried on a model: all are screened, the promising ones sketched, and those that may be the best fitted in
//! full.
//!
//! To rank them their costs are enough. What makes a candidate (evidence, detectability, intervals) wants a Jacobian of
//! its own and is only reckoned of those that are asked for.

use std::collections::HashSet;
use std::sync::OnceLock;

use rayon::prelude::*;

use super::adequacy::{Cell, adequate, cells, cells_since};
use super::belief::BELIEVED;
use super::candidate::{Candidate, jacobian_by, slow_columns, weigh, weigh_by};
use super::evidence::{log_odds, shares};
use super::experiment::Experiment;
use super::fit::{Fit, evaluate_weighted, refine};
use super::forms::said;
use super::frame::Frame;
use super::jacobian::SlowColumns;
use super::lateness::on_time;
use super::needle::threaded;
use super::scans::Scans;
use super::shortlist::{Shortlist, Sketch, may_catch_up};
use crate::effects::{AddedEffect, Effect};
use crate::model::Model;

/// Falls of the cost that are worth a sketch and a fit, as shares of the least one that would be believed.
const WORTH_A_SKETCH: f64 = 0.06;
const WORTH_A_FIT: f64 = 0.25;

/// Smallest detectability that is believed, sigmas. Channels a few milliseconds out of step, a logger's rounding and
/// the plant's discretisation make signatures of up to 0.05 on steady and 0.09 on ringing campaigns with nothing
/// hidden.
pub(super) const VISIBLE: f64 = 0.1;

/// Logarithm of how much rarer than usual forms those are that say more: where another effect explains as much, it is
/// that one.
const RARER: f64 = 3.0;

/// Logarithm of how much rarer effects in their forms are than in their usual ones.
pub(super) fn rarity<'a>(effects: impl IntoIterator<Item = &'a AddedEffect>) -> f64 {
    let rarer = effects.into_iter().filter(|added| added.effect.refines());
    RARER * rarer.count() as f64
}

/// Share of what an effect explains that no twin of it explains less of. One at the angle of the least alike that is
/// tried explains two thirds, were there not what else is missing.
const UNLIKE: f64 = 0.07;

/// Smallest detectability that is believed where the model is adequate without the effect: what is left is noise
/// already, and what a faint signature explains of it may as well be the instruments' own.
const VISIBLE_IN_NOISE: f64 = 0.15;

/// Smallest detectability that is worth a try, sigmas, where a model leaves no more than noise or more.
fn visible(noise: bool) -> f64 {
    if noise { VISIBLE_IN_NOISE } else { VISIBLE }
}

/// Effects tried on one fitted model, the most likely first.
pub struct Trials<'a> {
    experiment: &'a Experiment,
    model: &'a Model,
    base: &'a Fit,
    /// Whether the base leaves no more than noise.
    noise: bool,
    slow: SlowColumns,
    /// Each effect in its likeliest form, the likeliest first.
    ranked: Vec<Trial>,
    /// The other forms, the likeliest first.
    other_forms: Vec<Trial>,
}

/// One effect tried.
struct Trial {
    effect: &'static dyn Effect,
    fit: Fit,
    /// What the fit leaves under the yardsticks of the base.
    cost: f64,
    /// What the sketch left of the cost, or the screen once all else had adapted.
    sketched_cost: f64,
    pace: Pace,
    /// Logarithm of the odds that the effect is there; not a number before all are tried.
    log_odds: f64,
    weighed: OnceLock<Candidate>,
}

/// How far a trial went.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Pace {
    /// The screen found nothing of the effect.
    Absent,
    /// Screened or sketched, near the base.
    Sketched,
    /// Fitted in full.
    Fitted,
}

/// Tries effects on a fitted model and weighs all; best first.
#[must_use]
pub fn try_effects(
    experiment: &Experiment,
    model: &Model,
    base: &Fit,
    effects: &[&'static dyn Effect],
    progress: &(dyn Fn(&str) + Sync),
) -> Vec<Candidate> {
    let before = cells(experiment, base);
    let scans = Scans::default();
    Trials::new(
        experiment,
        model,
        (&before, base),
        effects,
        &scans,
        progress,
    )
    .all_weighed()
}

impl<'a> Trials<'a> {
    /// Tries effects on a base to which a model with other cells has come, with the fine searches of the rounds before;
    /// `progress` is told of each.
    #[must_use]
    pub fn new(
        experiment: &'a Experiment,
        model: &'a Model,
        (before, base): (&[Cell], &'a Fit),
        effects: &[&'static dyn Effect],
        scans: &Scans,
        progress: &(dyn Fn(&str) + Sync),
    ) -> Self {
        let slow = slow_columns(experiment, model, base);
        let jacobian = jacobian_by(experiment, model, base, &slow);
        let cells = cells_since(before, experiment, base);
        let noise = adequate(experiment, &cells, base);
        // An effect that is barely visible explains this much.
        let believed = BELIEVED.max(base.weights.count() as f64 * visible(noise).powi(2));
        let drafted = experiment.drafted(model, &base.estimate);
        let shortlist = Shortlist {
            experiment: &drafted,
            model,
            base,
            frame: Frame::new(&jacobian, &base.estimate, 0..0),
            worthwhile: WORTH_A_SKETCH * believed,
            scans,
        };
        let sketches = shortlist.sketches(effects);
        let best = sketches.first().map_or(base.cost, |first| first.found.cost);
        let trial = |(rank, sketch): (usize, Sketch)| {
            let promising = rank == 0 || may_catch_up(&sketch.found, base.cost, best);
            let worthwhile = base.cost - sketch.found.cost > WORTH_A_FIT * believed;
            let trial = Trial::new(experiment, model, base, sketch, promising && worthwhile);
            progress(trial.effect.id());
            trial
        };
        let ranked = sketches.into_par_iter().enumerate().map(trial).collect();
        let mut trials = Self {
            experiment,
            model,
            base,
            noise,
            slow,
            ranked,
            other_forms: Vec::new(),
        };
        trials.rank();
        trials
    }

    /// Sorts by the odds, the best first, and keeps of an effect with several forms the likelier one.
    fn rank(&mut self) {
        let best = self.ranked.iter().min_by(|a, b| a.cost.total_cmp(&b.cost));
        let Some(best) = best else {
            return;
        };
        let odds = Odds::new(self.base, self.weighed(best));
        for trial in &mut self.ranked {
            trial.log_odds = odds.of_last(&trial.fit, 1, trial.cost);
        }
        self.ranked
            .sort_by(|a, b| b.log_odds.total_cmp(&a.log_odds));
        let mut named = HashSet::new();
        (self.ranked, self.other_forms) = std::mem::take(&mut self.ranked)
            .into_iter()
            .partition(|trial| named.insert(trial.effect.id()));
    }

    /// Weighs a trial, once.
    fn weighed<'t>(&self, trial: &'t Trial) -> &'t Candidate {
        let (experiment, model, base) = (self.experiment, self.model, self.base);
        let (effect, fit) = (trial.effect, &trial.fit);
        trial.weighed.get_or_init(|| match trial.pace {
            Pace::Absent => Candidate::absent(effect, fit.clone()),
            Pace::Sketched => weigh_by(experiment, model, base, effect, fit.clone(), &self.slow),
            Pace::Fitted => weigh(experiment, model, base, effect, fit.clone()),
        })
    }

    /// What the effects are tried on.
    #[must_use]
    pub fn base(&self) -> &Fit {
        self.base
    }

    /// Smallest detectability that is believed here, sigmas, and whether the base leaves no more than noise.
    #[must_use]
    pub fn visible(&self) -> (f64, bool) {
        (visible(self.noise), self.noise)
    }

    /// All candidates, the most likely first.
    #[must_use]
    pub fn all_weighed(&self) -> Vec<Candidate> {
        let ranked = self.ranked.par_iter();
        ranked.map(|trial| self.weighed(trial).clone()).collect()
    }

    /// Probability of each among all and none, the most likely first.
    #[must_use]
    pub fn confidences(&self) -> Vec<f64> {
        let none = 0.0;
        let odds = self.ranked.iter().map(|trial| trial.log_odds);
        let odds: Vec<f64> = odds.chain([none]).collect();
        let mut confidences = shares(&odds);
        confidences.truncate(self.ranked.len());
        confidences
    }

    /// The candidates, the most likely first, whose cost falls far enough for as much evidence as `believed` asks of
    /// their effect; each is weighed as it is come to.
    pub fn likely(
        &self,
        believed: impl Fn(&dyn Effect) -> f64,
    ) -> impl Iterator<Item = &Candidate> {
        self.ranked
            .iter()
            .filter(move |trial| self.base.cost - trial.cost >= believed(trial.effect))
            .map(|trial| self.weighed(trial))
    }

    /// Effects that explain next to nothing of what a candidate does in any of their forms.
    pub fn unlike(&self, candidate: &Candidate) -> Vec<&'static str> {
        let most = self.base.cost - UNLIKE * candidate.fallen();
        let all = || self.ranked.iter().chain(&self.other_forms);
        let like = all().filter(|trial| trial.sketched_cost.min(trial.cost) < most);
        let like: HashSet<&str> = like.map(|trial| trial.effect.id()).collect();
        let ids = self.ranked.iter().map(|trial| trial.effect.id());
        ids.filter(|id| !like.contains(id)).collect()
    }

    /// The likeliest form of a candidate's effect that says less than it, fitted in full, if there is one.
    pub fn plainer(&self, candidate: &Candidate) -> Option<Candidate> {
        let mut forms = self.other_forms.iter();
        let plainer = forms.find(|trial| {
            let same = trial.effect.id() == candidate.effect.id();
            same && said(trial.effect) < said(candidate.effect)
        })?;
        let (experiment, model) = (self.experiment, self.model);
        let fit = refine(experiment, model, plainer.fit.estimate.clone());
        Some(weigh(experiment, model, self.base, plainer.effect, fit))
    }
}

impl Trial {
    fn new(
        experiment: &Experiment,
        model: &Model,
        base: &Fit,
        sketch: Sketch,
        in_full: bool,
    ) -> Self {
        let (effect, sketched_cost) = (sketch.effect, sketch.found.cost);
        let (pace, fit) = if sketch.is_absent() {
            let estimate = sketch.found.estimate;
            let fit = Fit {
                estimate,
                ..base.clone()
            };
            (Pace::Absent, fit)
        } else if in_full {
            let fit = refine(experiment, model, sketch.found.estimate);
            let fit = on_time(experiment, model, fit);
            (Pace::Fitted, threaded(experiment, model, fit))
        } else {
            let weights = base.weights.clone();
            let fit = evaluate_weighted(experiment, model, sketch.found.estimate, weights);
            (Pace::Sketched, fit)
        };
        let cost = match pace {
            Pace::Fitted => fit.cost_beside(experiment, model, base),
            Pace::Absent | Pace::Sketched => fit.cost,
        };
        Self {
            effect,
            fit,
            cost,
            sketched_cost,
            pace,
            log_odds: f64::NAN,
            weighed: OnceLock::new(),
        }
    }
}

/// The odds of effects against their common base, all at the inflation of the one with the least cost: each at its own
/// would prefer what leaves a rest that hardly correlates with its signature over what leaves less.
pub(super) struct Odds {
    base_cost: f64,
    /// What the cost falls by for a likelihood ratio of one.
    unit: f64,
    effective_samples: f64,
}

impl Odds {
    /// The odds beside the candidate with the least cost.
    pub(super) fn new(base: &Fit, best: &Candidate) -> Self {
        Self {
            base_cost: base.cost,
            unit: best.fit.variance() * best.inflation,
            effective_samples: best.effective_samples(),
        }
    }

    /// Logarithm of the odds that the last effects of a fit, which leaves so much of the cost, are there together.
    pub(super) fn of_last(&self, fit: &Fit, count: usize, cost: f64) -> f64 {
        let ratio = (self.base_cost - cost) / self.unit;
        let effects = &fit.estimate.effects;
        let counted = &effects[effects.len().saturating_sub(count)..];
        let parameters = counted.iter().map(|added| added.values.len()).sum();
        log_odds(ratio, parameters, self.effective_samples) - rarity(counted)
    }
}
