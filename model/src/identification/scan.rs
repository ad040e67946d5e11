//! A fine search for the size of an effect that jumps or bounces, on the run that tells most of it.
//!
//! A spool that sticks on a ramp jumps once a band: with a band that is a fiftieth off, the twentieth jump comes at
//! the wrong time, and the fit is worse than without the effect. No secant leads there. But one ramp is enough to see
//! it, and a second of computing goes through a thousand of them.

use rayon::prelude::*;

use super::experiment::Experiment;
use super::fit::Fit;
use super::jacobian::{huber, residuals, square_sum};
use crate::effects::{AddedEffect, Parameter};
use crate::model::Model;

/// Smallest and largest size, in typical sizes, and the ratio from one to the next.
const SMALLEST: f64 = 0.12;
const LARGEST: f64 = 4.0;
const FINER: f64 = 1.008;

/// Values of a shape from one end of its range to the other.
const SHAPES: usize = 3;

/// How many of the best are looked at more closely, and how far apart they are at least, as a share of the size.
const BEST: usize = 2;
const APART: f64 = 0.03;

/// The closer looks: how far to either side, as a share of the size and of the range of a shape.
const CLOSER: [(f64, f64); 3] = [(0.01, 0.25), (0.002, 0.05), (0.000_4, 0.01)];

/// Values of a closer look to either side.
const TO_EITHER_SIDE: i32 = 5;

/// The sizes and shapes of an effect that fit the run best which it changes most; `hint` is any size of it.
pub(super) fn scan(
    experiment: &Experiment,
    model: &Model,
    base: &Fit,
    hint: &AddedEffect,
) -> Vec<AddedEffect> {
    let Some(run) = telling_run(experiment, model, base, hint) else {
        return Vec::new();
    };
    let ready = &experiment.runs[run];
    // Jumps and bounces are seen without the ringing, at a tenth of the time.
    let model = &model.quasi_static();
    let cost = |added: &AddedEffect| -> f64 {
        let mut effects = base.estimate.effects.clone();
        effects.push(added.clone());
        let model = model.with_effects(effects);
        let (nuisance, clocks) = (base.estimate.nuisances[run], &base.estimate.clocks);
        let trace = ready.simulate(&model, nuisance, clocks, 0.0);
        square_sum(&huber(vec![base.weights.runs[run].whiten(ready, &trace)]))
    };
    let ranked = |grid: Vec<AddedEffect>| {
        let mut tried: Vec<(f64, AddedEffect)> = grid
            .into_par_iter()
            .map(|added| (cost(&added), added))
            .collect();
        tried.sort_by(|a, b| a.0.total_cmp(&b.0));
        tried
    };
    let mut best: Vec<AddedEffect> = Vec::new();
    for (_, added) in ranked(coarse(hint)) {
        let apart = |other: &AddedEffect| {
            let (a, b) = (added.values[0], other.values[0]);
            (a - b).abs() > APART * a.abs().max(b.abs())
        };
        if best.len() < BEST && best.iter().all(apart) {
            best.push(added);
        }
    }
    let closer = |added: AddedEffect| {
        CLOSER.iter().fold(added, |best, reach| {
            ranked(around(&best, *reach)).swap_remove(0).1
        })
    };
    best.into_iter().map(closer).collect()
}

/// The run whose residuals the effect changes most.
fn telling_run(
    experiment: &Experiment,
    model: &Model,
    base: &Fit,
    hint: &AddedEffect,
) -> Option<usize> {
    let mut with = base.estimate.clone();
    with.effects.push(hint.clone());
    let changed = residuals(experiment, model, &base.weights, &with);
    let change = |&run: &usize| -> f64 {
        let both = changed[run].iter().zip(&base.residuals[run]);
        both.map(|(with, without)| (with - without).powi(2)).sum()
    };
    (0..experiment.runs.len()).max_by(|a, b| change(a).total_cmp(&change(b)))
}

/// Every size with every shape.
fn coarse(hint: &AddedEffect) -> Vec<AddedEffect> {
    let size = &hint.effect.parameters()[0];
    let steps = ((LARGEST / SMALLEST).ln() / FINER.ln()) as i32;
    let mut sizes: Vec<f64> = (0..=steps)
        .map(|step| size.null + SMALLEST * FINER.powi(step) * (size.typical - size.null))
        .filter(|value| (size.low..=size.high).contains(value))
        .collect();
    grid(hint, |index, range| {
        if index == 0 {
            return std::mem::take(&mut sizes);
        }
        let share = |k: usize| k as f64 / (SHAPES - 1) as f64;
        (0..SHAPES)
            .map(|k| range.low + share(k) * (range.high - range.low))
            .collect()
    })
}

/// Sizes and shapes around others.
fn around(at: &AddedEffect, (size_reach, shape_reach): (f64, f64)) -> Vec<AddedEffect> {
    grid(at, |index, range| {
        let reach = if index == 0 {
            size_reach * (at.values[0] - range.null)
        } else {
            shape_reach * (range.high - range.low)
        };
        let mut values: Vec<f64> = (-TO_EITHER_SIDE..=TO_EITHER_SIDE)
            .map(|k| at.values[index] + reach * f64::from(k) / f64::from(TO_EITHER_SIDE))
            .map(|value| value.clamp(range.low, range.high))
            .collect();
        values.dedup();
        values
    })
}

/// All combinations of the values of an effect's parameters.
fn grid(
    of: &AddedEffect,
    mut values: impl FnMut(usize, &Parameter) -> Vec<f64>,
) -> Vec<AddedEffect> {
    let parameters = of.effect.parameters().iter().enumerate();
    parameters.fold(vec![of.clone()], |grid, (index, range)| {
        let values = values(index, range);
        grid.iter()
            .flat_map(|added| {
                values.iter().map(|&value| {
                    let mut moved = added.clone();
                    moved.values[index] = value;
                    moved
                })
            })
            .collect()
    })
}
