//! Where the fit of an effect starts: its size and shape looked for along secants.

use super::candidate::{STARTS, WORTH_A_FIT};
use super::estimate::Estimate;
use super::experiment::Experiment;
use super::fit::Fit;
use super::frame::Frame;
use super::jacobian::{Jacobian, huber_residuals};
use crate::campaign::Channel;
use crate::effects::{AddedEffect, Effect};
use crate::model::Model;

/// Sizes of the secants, in typical sizes: derivatives at zero miss a play or a gap, one size misses what saturates.
const SIZES: [f64; 3] = [0.1, 1.0, 4.0];

/// The same where the cost has many valleys and a secant is no guide from one to the next.
const DENSE_SIZES: [f64; 7] = [0.1, 0.3, 0.6, 1.0, 2.0, 4.0, 8.0];

/// Sizes that are tried next to the best of those, in its own size: a valley may be a tenth wide.
const NEXT_SIZES: [f64; 6] = [0.7, 0.8, 0.9, 1.12, 1.25, 1.4];

/// Sizes that differ by less than this share of the larger are one start.
const SAME_VALLEY: f64 = 0.08;

/// How far a secant is trusted, in its own size.
const REACH: f64 = 8.0;

/// The most promising sizes, those at which the least cost is left once all else has adapted, with the least such cost;
/// at least one.
pub(super) fn starts(
    experiment: &Experiment,
    model: &Model,
    base: &Fit,
    jacobian: &Jacobian,
    effect: &'static dyn Effect,
) -> (f64, Vec<Estimate>) {
    let frame = Frame::new(jacobian, &base.estimate, None);
    // Of every secant both its end and the best point along it: the one is sure, the other may be far better.
    let rank = |added: Vec<AddedEffect>| {
        let mut ranked: Vec<(f64, Estimate)> = added
            .into_iter()
            .flat_map(|added| {
                let end = with(&base.estimate, added.clone());
                let residuals = huber_residuals(experiment, model, &base.weights, &end);
                let (lowest, highest) = reach(&added);
                let (share, cost) = frame.along(&residuals, lowest, highest);
                let range = &added.effect.parameters()[0];
                let mut best = added;
                best.values[0] = range.null + share * (best.values[0] - range.null);
                let best = with(&base.estimate, best);
                [(cost, best), (frame.cost_after(&residuals), end)]
            })
            .collect();
        ranked.sort_by(|a, b| a.0.total_cmp(&b.0));
        ranked
    };
    let mut ranked = rank(sizes(experiment, effect));
    if let Some((cost, best)) = ranked.first().cloned()
        && base.cost - cost > WORTH_A_FIT
    {
        let best = best.effects.last().expect("pushed above").clone();
        ranked.extend(rank(shapes(&best)));
        ranked.sort_by(|a, b| a.0.total_cmp(&b.0));
        if has_valleys(experiment, effect) {
            let best = ranked[0].1.effects.last().expect("pushed above").clone();
            ranked.extend(rank(neighbours(&best)));
            ranked.sort_by(|a, b| a.0.total_cmp(&b.0));
        }
    }
    let predicted = ranked.first().map_or(base.cost, |first| first.0);
    let mut starts: Vec<Estimate> = Vec::new();
    for (_, start) in ranked {
        if starts.len() < STARTS && starts.iter().all(|other| apart(other, &start)) {
            starts.push(start);
        }
    }
    (predicted, starts)
}

/// Whether the last effects of two estimates are sizes that lead to different valleys.
fn apart(a: &Estimate, b: &Estimate) -> bool {
    let last = |estimate: &Estimate| estimate.effects.last().map(|added| added.values.clone());
    let (Some(a), Some(b)) = (last(a), last(b)) else {
        return true;
    };
    let alike = |x: f64, y: f64| (x - y).abs() <= SAME_VALLEY * x.abs().max(y.abs());
    !(alike(a[0], b[0]) && a[1..] == b[1..])
}

fn with(estimate: &Estimate, added: AddedEffect) -> Estimate {
    let mut with = estimate.clone();
    with.effects.push(added);
    with
}

/// Whether an effect's cost has many valleys: the phase of a ringing pressure makes them, and a shape beside the size.
pub(super) fn has_valleys(experiment: &Experiment, effect: &dyn Effect) -> bool {
    let rings = experiment.ringing && effect.channels() == [Channel::CylinderPressure];
    rings || effect.parameters().len() > 1
}

/// An effect at the sizes of the secants.
fn sizes(experiment: &Experiment, effect: &'static dyn Effect) -> Vec<AddedEffect> {
    let size = &effect.parameters()[0];
    let sizes = if has_valleys(experiment, effect) {
        &DENSE_SIZES[..]
    } else {
        &SIZES
    };
    sizes
        .iter()
        .map(|s| {
            let mut added = AddedEffect::typical(effect);
            added.values[0] = size.null + s * (size.typical - size.null);
            added
        })
        .filter(|added| (size.low..=size.high).contains(&added.values[0]))
        .collect()
}

/// An effect at sizes next to the one it has.
fn neighbours(at: &AddedEffect) -> Vec<AddedEffect> {
    let size = &at.effect.parameters()[0];
    NEXT_SIZES
        .iter()
        .map(|s| {
            let mut added = at.clone();
            added.values[0] = size.null + s * (at.values[0] - size.null);
            added
        })
        .filter(|added| (size.low..=size.high).contains(&added.values[0]))
        .collect()
}

/// Smallest and largest multiple of an effect's size that its range and the trust in a secant allow.
fn reach(added: &AddedEffect) -> (f64, f64) {
    let range = &added.effect.parameters()[0];
    let size = added.values[0] - range.null;
    let ends = [range.low, range.high].map(|end| (end - range.null) / size);
    (
        ends[0].min(ends[1]).max(-REACH),
        ends[0].max(ends[1]).min(REACH),
    )
}

/// An effect with each parameter of its shape at either end of its range in turn; none without a shape.
fn shapes(at: &AddedEffect) -> Vec<AddedEffect> {
    let parameters = at.effect.parameters().iter().enumerate().skip(1);
    parameters
        .flat_map(|(index, range)| {
            let ends = [range.low, range.high].into_iter();
            ends.filter(|end| end.is_finite()).map(move |end| {
                let mut added = at.clone();
                added.values[index] = end;
                added
            })
        })
        .collect()
}
