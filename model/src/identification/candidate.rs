//! One effect of the catalogue tried on a model: started from finite secants, fitted, weighed.

use rayon::prelude::*;

use super::estimate::{Estimate, Shared};
use super::evidence::{detectability, log_odds, variance_inflation};
use super::experiment::Experiment;
use super::fit::{Fit, evaluate_weighted, refine, sketch};
use super::frame::Frame;
use super::jacobian::{Jacobian, SlowColumns, huber, huber_residuals, square_sum};
use super::starts::{starts, valleys};
use crate::effects::{AddedEffect, Effect, Parameter};
use crate::model::Model;

/// See [`systematic`].
const SYSTEMATIC_A: f64 = 0.000_7;
const SYSTEMATIC_S: f64 = 0.001;
const SYSTEMATIC_SHARE: f64 = 0.005;

/// How many starts of an effect are sketched while the model is far from the data: there are valleys to fall into.
pub(super) const STARTS: usize = 2;

/// Error from which a model counts as far from the data.
const FAR: f64 = 1.3;

/// A sketch that leaves less than this share of the cost needs no second start.
const ARRIVED: f64 = 0.3;

/// An effect is sketched if its screened cost is among the first so many,
const ALWAYS_SKETCHED: usize = 4;
/// or leaves at most this share of what the best screened one explains unexplained.
const DOUBTFUL: f64 = 0.6;

/// An effect is fitted in full if its sketch is among the first so many,
const ALWAYS_FITTED: usize = 2;
/// or leaves at most this share of what the best sketch explains unexplained,
const HOPELESS: f64 = 0.3;
/// or is within this cost of the best,
const HOPELESS_COST: f64 = 60.0;
/// provided that the sketch explains more than this cost: half of what belief asks for.
pub(super) const WORTH_A_FIT: f64 = 5.0;

/// An effect fitted beside everything that was free already.
#[derive(Debug, Clone)]
pub struct Candidate {
    /// Which effect.
    pub effect: &'static dyn Effect,
    /// The fitted model with it.
    pub fit: Fit,
    /// Fall of the cost in units of the residuals' variance and the effect's variance inflation: about chi-squared
    /// with one degree of freedom where the effect is absent.
    pub likelihood_ratio: f64,
    /// Variance inflation of the effect.
    pub inflation: f64,
    /// Root mean square of its projected signature at the fitted size, in sigmas.
    pub detectability: f64,
    /// 95 % intervals of its parameters, in their units; not numbers if the screen found nothing of the effect.
    pub intervals: Vec<(f64, f64)>,
}

impl Candidate {
    /// Logarithm of the odds that the effect is there: a shape of its own costs an effect as much as it has to explain.
    #[must_use]
    pub fn log_odds(&self) -> f64 {
        log_odds(
            self.likelihood_ratio,
            self.effect.parameters().len(),
            self.effective_samples(),
        )
    }

    /// Compared samples at their effective number.
    #[must_use]
    pub fn effective_samples(&self) -> f64 {
        self.fit.weights.count() as f64 / self.inflation
    }

    /// Fitted values of its parameters, in their units.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        let added = self.fit.estimate.effects.last();
        added.map_or(&[], |added| &added.values)
    }
}

/// Tries effects on a fitted model: all are screened, the promising ones sketched, and those that may be the best fitted
/// in full. Best first.
#[must_use]
pub fn try_effects(
    experiment: &Experiment,
    model: &Model,
    base: &Fit,
    effects: &[&'static dyn Effect],
    progress: &(dyn Fn(&str) + Sync),
) -> Vec<Candidate> {
    let slow = slow_columns(experiment, model, base);
    let jacobian = jacobian_by(experiment, model, base, &slow);
    let screened = screened(experiment, model, base, &jacobian, effects);
    let sketches = sketches(experiment, model, base, screened);
    let best = sketches.first().map_or(base.cost, |first| first.cost);
    let hopeless = limit(base.cost, best, HOPELESS);
    let mut candidates: Vec<Candidate> = sketches
        .into_par_iter()
        .enumerate()
        .map(|(rank, sketch)| {
            let promising = rank < ALWAYS_FITTED || sketch.cost < hopeless;
            let candidate = if sketch.is_absent() {
                absent(base, sketch)
            } else if promising && base.cost - sketch.cost > WORTH_A_FIT {
                let fit = refine(experiment, model, sketch.estimate);
                weigh(experiment, model, base, sketch.effect, fit)
            } else {
                let weights = base.weights.clone();
                let fit = evaluate_weighted(experiment, model, sketch.estimate, weights);
                weigh_by(experiment, model, base, sketch.effect, fit, &slow)
            };
            progress(candidate.effect.id());
            candidate
        })
        .collect();
    rank(base, &mut candidates);
    candidates
}

/// Sorts candidates by their odds against each other, the best first.
///
/// All are counted at the inflation of the one with the least cost: each at its own would prefer what leaves a rest that
/// hardly correlates with its signature over what leaves less.
fn rank(base: &Fit, candidates: &mut [Candidate]) {
    let Some(odds) = mutual_odds(base, candidates) else {
        return;
    };
    candidates.sort_by(|a, b| odds(b).total_cmp(&odds(a)));
}

/// Logarithm of the odds of candidates against their common base, all at one inflation; `None` without candidates.
pub fn mutual_odds(
    base: &Fit,
    candidates: &[Candidate],
) -> Option<impl Fn(&Candidate) -> f64 + use<>> {
    let best = candidates
        .iter()
        .min_by(|a, b| a.fit.cost.total_cmp(&b.fit.cost))?;
    let compared = best.fit.weights.count() as f64;
    let variance = (square_sum(&best.fit.residuals) / compared).max(1.0);
    let (inflation, effective, base_cost) = (best.inflation, best.effective_samples(), base.cost);
    Some(move |candidate: &Candidate| {
        let ratio = (base_cost - candidate.fit.cost) / (variance * inflation);
        log_odds(ratio, candidate.effect.parameters().len(), effective)
    })
}

/// An effect after the screen: what it might leave, and where to start from; at least one start.
struct Screened {
    effect: &'static dyn Effect,
    predicted: f64,
    starts: Vec<Estimate>,
}

/// An effect roughly fitted.
struct Sketch {
    effect: &'static dyn Effect,
    cost: f64,
    estimate: Estimate,
}

impl Sketch {
    /// Whether the screen found nothing of the effect.
    fn is_absent(&self) -> bool {
        self.estimate
            .effects
            .last()
            .is_none_or(AddedEffect::is_null)
    }
}

/// Screens effects by finite secants, the most promising first.
fn screened(
    experiment: &Experiment,
    model: &Model,
    base: &Fit,
    jacobian: &Jacobian,
    effects: &[&'static dyn Effect],
) -> Vec<Screened> {
    let mut screened: Vec<Screened> = effects
        .par_iter()
        .map(|&effect| {
            let (predicted, starts) = starts(experiment, model, base, jacobian, effect);
            Screened {
                effect,
                predicted,
                starts,
            }
        })
        .collect();
    screened.sort_by(|a, b| a.predicted.total_cmp(&b.predicted));
    screened
}

/// Sketches the screened effects that have a chance, the best first.
fn sketches(
    experiment: &Experiment,
    model: &Model,
    base: &Fit,
    screened: Vec<Screened>,
) -> Vec<Sketch> {
    let best = screened.first().map_or(base.cost, |first| first.predicted);
    let hopeless = limit(base.cost, best, DOUBTFUL);
    let mut sketches: Vec<Sketch> = screened
        .into_par_iter()
        .enumerate()
        .map(|(rank, mut screened)| {
            let promising = rank < ALWAYS_SKETCHED || screened.predicted < hopeless;
            let (cost, estimate) = if base.cost - screened.predicted <= WORTH_A_FIT {
                let mut without = base.estimate.clone();
                without.effects.push(AddedEffect::null(screened.effect));
                (base.cost, without)
            } else if promising {
                sketch_starts(experiment, model, base, screened.starts)
            } else {
                (screened.predicted, screened.starts.swap_remove(0))
            };
            Sketch {
                effect: screened.effect,
                cost,
                estimate,
            }
        })
        .collect();
    sketches.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    sketches
}

/// Cost above which an effect is given up, when the best of its kind leaves `best` of `base`.
fn limit(base: f64, best: f64, share: f64) -> f64 {
    best + (share * (base - best)).max(HOPELESS_COST)
}

/// Sketches from one start, and from the next where the first leads nowhere; returns the best cost and estimate.
fn sketch_starts(
    experiment: &Experiment,
    model: &Model,
    base: &Fit,
    starts: Vec<Estimate>,
) -> (f64, Estimate) {
    let far = base.error() > FAR;
    // Where there are valleys the starts have been looked for one by one; a coarse fit would lead away from them.
    let valleys = starts.iter().any(|start| {
        let last = start.effects.last();
        last.is_some_and(|added| valleys(experiment, added.effect).is_some())
    });
    let mut best = (base.cost, base.estimate.clone());
    for start in starts.into_iter().take(if far { STARTS } else { 1 }) {
        let found = sketch(experiment, model, &base.weights, start, far && !valleys);
        if best.1.effects.len() < found.1.effects.len() || found.0 < best.0 {
            best = found;
        }
        if best.0 < ARRIVED * base.cost {
            break;
        }
    }
    best
}

/// The candidate of an effect that the screen found nothing of.
fn absent(base: &Fit, sketch: Sketch) -> Candidate {
    Candidate {
        effect: sketch.effect,
        fit: Fit {
            estimate: sketch.estimate,
            ..base.clone()
        },
        likelihood_ratio: 0.0,
        inflation: 1.0,
        detectability: 0.0,
        intervals: vec![(f64::NAN, f64::NAN); sketch.effect.parameters().len()],
    }
}

/// Weighs the last effect of a fitted model against the model without it.
#[must_use]
pub fn weigh(
    experiment: &Experiment,
    model: &Model,
    base: &Fit,
    effect: &'static dyn Effect,
    fit: Fit,
) -> Candidate {
    let slow = slow_columns(experiment, model, &fit);
    weigh_by(experiment, model, base, effect, fit, &slow)
}

/// Columns of clocks and loads at a fit, whose residuals are known.
fn slow_columns(experiment: &Experiment, model: &Model, fit: &Fit) -> SlowColumns {
    let residuals = huber(fit.residuals.clone());
    SlowColumns::new(experiment, model, &fit.weights, &fit.estimate, &residuals)
}

/// Sensitivities at a fit, whose residuals are known, with the columns of clocks and loads from there or nearby.
fn jacobian_by(experiment: &Experiment, model: &Model, fit: &Fit, slow: &SlowColumns) -> Jacobian {
    let residuals = huber(fit.residuals.clone());
    let (weights, estimate) = (&fit.weights, &fit.estimate);
    Jacobian::with_slow_columns(experiment, model, weights, estimate, &residuals, slow)
}

/// [`weigh`] with the columns of clocks and loads from a point nearby.
fn weigh_by(
    experiment: &Experiment,
    model: &Model,
    base: &Fit,
    effect: &'static dyn Effect,
    fit: Fit,
    slow: &SlowColumns,
) -> Candidate {
    let index = fit.estimate.effects.len() - 1;
    let jacobian = jacobian_by(experiment, model, &fit, slow);
    let compared = fit.weights.count() as f64;
    let variance = (square_sum(&fit.residuals) / compared).max(1.0);
    let signatures: Vec<Signature> = (0..effect.parameters().len())
        .map(|parameter| Signature::new(experiment, &fit, &jacobian, index, parameter))
        .collect();
    let Seen {
        detectability,
        inflation,
    } = Seen::new(experiment, model, &fit, &jacobian);
    let intervals = signatures
        .iter()
        .map(|signature| {
            let deviation = (variance * signature.inflation / signature.square).sqrt();
            let value = fit.estimate.get(signature.shared);
            let range = &effect.parameters()[signature.parameter];
            let half = 1.96
                * (deviation * fit.estimate.scale(signature.shared))
                    .hypot(systematic(range, value));
            (
                (value - half).max(range.low),
                (value + half).min(range.high),
            )
        })
        .collect();
    Candidate {
        effect,
        likelihood_ratio: (base.cost - fit.cost) / (variance * inflation),
        inflation,
        detectability,
        intervals,
        fit,
    }
}

/// One sigma of what no number of samples takes away from a parameter, in its unit.
///
/// A log tells where a ramp of the current bends only to within a sample, and the last of its noise holds a play open:
/// some 0.7 mA, and as much time as a tenth of a sample. Loads, areas and tables are good to half a percent.
fn systematic(parameter: &Parameter, value: f64) -> f64 {
    let absolute = match parameter.unit {
        "A" => SYSTEMATIC_A,
        "s" => SYSTEMATIC_S,
        _ => 0.0,
    };
    absolute.hypot(SYSTEMATIC_SHARE * value)
}

/// A parameter's signature with all that is free besides it projected out.
struct Signature {
    parameter: usize,
    shared: Shared,
    square: f64,
    inflation: f64,
}

impl Signature {
    fn new(
        experiment: &Experiment,
        fit: &Fit,
        jacobian: &Jacobian,
        effect: usize,
        parameter: usize,
    ) -> Self {
        let shared = Shared::Effect(effect, parameter);
        let (projected, price) = projected(fit, jacobian, shared);
        Self {
            parameter,
            shared,
            square: (square_sum(&projected) + price).max(1e-12),
            inflation: variance_inflation(experiment, &fit.residuals, &projected),
        }
    }
}

/// A parameter's signature, a step of one scale, with all that is free besides it projected out, and what imitating it
/// costs in priors.
fn projected(fit: &Fit, jacobian: &Jacobian, shared: Shared) -> (Vec<Vec<f64>>, f64) {
    let column = jacobian.shared.iter().position(|&s| s == shared);
    let Some(column) = column else {
        let nothing = |run: &Vec<f64>| vec![0.0; run.len()];
        return (fit.residuals.iter().map(nothing).collect(), 0.0);
    };
    let signature = jacobian
        .runs
        .iter()
        .map(|run| run.shared[column].clone())
        .collect();
    Frame::new(jacobian, &fit.estimate, column..column + 1).project_at_a_price(signature)
}

/// How much of the last effect of a fit is seen.
struct Seen {
    /// Root mean square of what it changes at its fitted size, in sigmas, less what all that is free besides it can
    /// imitate.
    detectability: f64,
    /// Variance inflation of that change.
    inflation: f64,
}

impl Seen {
    /// From the whole change, not its derivative: an effect that begins late, or jumps, is less than that promises.
    fn new(experiment: &Experiment, model: &Model, fit: &Fit, jacobian: &Jacobian) -> Self {
        let last = fit.estimate.effects.len() - 1;
        let mut without = fit.estimate.clone();
        without.effects[last] = AddedEffect::null(without.effects[last].effect);
        let without = huber_residuals(experiment, model, &fit.weights, &without);
        let change = jacobian
            .runs
            .iter()
            .zip(without)
            .map(|(run, without)| {
                let both = without.iter().zip(&run.residual);
                both.map(|(without, with)| without - with).collect()
            })
            .collect();
        let own = |shared: &Shared| matches!(shared, Shared::Effect(effect, _) if *effect == last);
        let columns = &jacobian.shared;
        let first = columns.iter().position(own).unwrap_or(0);
        let count = columns.iter().filter(|shared| own(shared)).count();
        let frame = Frame::new(jacobian, &fit.estimate, first..first + count);
        let (left, price) = frame.project_at_a_price(change);
        Self {
            detectability: detectability(&left, price, fit.weights.count()),
            inflation: variance_inflation(experiment, &fit.residuals, &left),
        }
    }
}
