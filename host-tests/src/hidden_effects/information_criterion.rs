//! The method of parameter estimation tools: each effect is fitted alone, and the best Schwarz criterion selects one.
//!
//! As usual, samples count as independent, loads and clocks as exact, and no runs are held out. The optimiser gets the
//! best conditions: several starts, both signs, all parameters of an effect.

use hitch_campaign::Campaign;
use hitch_identification::data::experiment::Experiment;
use hitch_plant::{AddedEffect, Effect, Model};
use nalgebra::{DMatrix, DVector};

use super::answer::{Abilities, Answer, Method};
use super::residuals::Comparison;

/// Sizes that a fit is started from, in typical sizes.
const STARTS: [f64; 3] = [0.2, 1.0, 3.0];

/// How many of the best started effects are fitted in full.
const FITTED: usize = 5;

/// Most iterations of a fit.
const ITERATIONS: usize = 12;

/// Step of a difference quotient, in typical sizes.
const STEP: f64 = 0.02;

/// Refit with each effect alone.
#[derive(Debug)]
pub struct InformationCriterion;

/// An effect with its fitted values.
struct Fitted {
    added: AddedEffect,
    cost: f64,
}

impl Method for InformationCriterion {
    fn name(&self) -> &'static str {
        "refit and BIC"
    }

    fn abilities(&self) -> Abilities {
        Abilities {
            names: true,
            unknown: false,
            intervals: true,
        }
    }

    fn answer(&self, campaign: &Campaign, model: &Model) -> Answer {
        let experiment = Experiment::new(campaign, model);
        let comparison = Comparison::new(&experiment, model);
        let nothing = comparison.all(&[]);
        let price = (nothing.len() as f64).ln();
        let without = square_sum(&nothing);
        let criterion = |fitted: &Fitted| fitted.cost + price * fitted.added.values.len() as f64;
        let best = fits(&comparison)
            .into_iter()
            .min_by(|a, b| criterion(a).total_cmp(&criterion(b)));
        let Some(best) = best.filter(|best| criterion(best) < without) else {
            return Answer::default();
        };
        let id = best.added.effect.id().to_owned();
        let (low, high) = interval(&comparison, &best);
        Answer {
            named: vec![id.clone()],
            intervals: vec![(id, low, high)],
            ..Answer::default()
        }
    }
}

/// The most promising effects, fitted.
fn fits(comparison: &Comparison) -> Vec<Fitted> {
    let started = comparison.effects();
    let mut started: Vec<Fitted> = started
        .filter_map(|effect| best_start(comparison, effect))
        .collect();
    started.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    started.truncate(FITTED);
    started
        .into_iter()
        .map(|start| fit(comparison, start))
        .collect()
}

/// An effect at the best of a few sizes.
fn best_start(comparison: &Comparison, effect: &'static dyn Effect) -> Option<Fitted> {
    let cost = |added: &AddedEffect| square_sum(&comparison.all(std::slice::from_ref(added)));
    let started = starts(effect).into_iter().map(|added| Fitted {
        cost: cost(&added),
        added,
    });
    started.min_by(|a, b| a.cost.total_cmp(&b.cost))
}

/// An effect fitted alone from the best of a few sizes.
pub(super) fn started_and_fitted(
    comparison: &Comparison,
    effect: &'static dyn Effect,
) -> Option<AddedEffect> {
    let start = best_start(comparison, effect)?;
    Some(fit(comparison, start).added)
}

fn starts(effect: &'static dyn Effect) -> Vec<AddedEffect> {
    let size = &effect.parameters()[0];
    let signs: &[f64] = if size.low < size.null {
        &[1.0, -1.0]
    } else {
        &[1.0]
    };
    let sizes = STARTS
        .iter()
        .flat_map(|start| signs.iter().map(move |sign| start * sign));
    sizes
        .map(|share| {
            let mut added = AddedEffect::typical(effect);
            added.values[0] =
                (size.null + share * (size.typical - size.null)).clamp(size.low, size.high);
            added
        })
        .collect()
}

/// Levenberg-Marquardt over all parameters of the effect, in typical sizes.
fn fit(comparison: &Comparison, mut best: Fitted) -> Fitted {
    let mut damping = 1e-3;
    for _ in 0..ITERATIONS {
        let (residuals, jacobian) = linearised(comparison, &best.added);
        let normal = jacobian.transpose() * &jacobian;
        let pull = jacobian.transpose() * residuals;
        let before = best.cost;
        for _ in 0..5 {
            let mut damped = normal.clone();
            for k in 0..damped.nrows() {
                damped[(k, k)] += damping * damped[(k, k)] + 1e-12;
            }
            let Some(step) = damped.cholesky().map(|factor| factor.solve(&pull)) else {
                break;
            };
            let trial = moved(&best.added, step.as_slice());
            let cost = square_sum(&comparison.all(std::slice::from_ref(&trial)));
            if cost < best.cost {
                best = Fitted { added: trial, cost };
                damping *= 0.1;
                break;
            }
            damping *= 20.0;
        }
        if before - best.cost < 1e-4 * before.min(1e4) {
            break;
        }
    }
    best
}

/// Residuals, and their reduction by a typical size of each parameter.
fn linearised(comparison: &Comparison, added: &AddedEffect) -> (DVector<f64>, DMatrix<f64>) {
    let at = |added: &AddedEffect| comparison.all(std::slice::from_ref(added));
    let here = at(added);
    let mut jacobian = DMatrix::zeros(here.len(), added.values.len());
    for parameter in 0..added.values.len() {
        let mut step = vec![0.0; added.values.len()];
        step[parameter] = STEP;
        let mut there = moved(added, &step);
        let mut taken = STEP;
        if there.values == added.values {
            // At the upper bound: look the other way.
            step[parameter] = -STEP;
            there = moved(added, &step);
            taken = -STEP;
        }
        for (row, (here, there)) in here.iter().zip(at(&there)).enumerate() {
            jacobian[(row, parameter)] = (here - there) / taken;
        }
    }
    (DVector::from_vec(here), jacobian)
}

fn moved(added: &AddedEffect, step: &[f64]) -> AddedEffect {
    let mut moved = added.clone();
    let parameters = added.effect.parameters();
    for ((value, parameter), step) in moved.values.iter_mut().zip(parameters).zip(step) {
        *value = (*value + step * parameter.typical.abs()).clamp(parameter.low, parameter.high);
    }
    moved
}

/// 95 % interval of the size from the curvature, samples independent.
fn interval(comparison: &Comparison, fitted: &Fitted) -> (f64, f64) {
    let (residuals, jacobian) = linearised(comparison, &fitted.added);
    let variance = (residuals.norm_squared() / residuals.len() as f64).max(1.0);
    let normal = jacobian.transpose() * jacobian;
    let size = &fitted.added.effect.parameters()[0];
    let half = normal.try_inverse().map_or(f64::INFINITY, |inverse| {
        1.96 * (variance * inverse[(0, 0)].abs()).sqrt() * size.typical.abs()
    });
    let value = fitted.added.values[0];
    (value - half, value + half)
}

fn square_sum(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum()
}
