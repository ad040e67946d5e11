//! Effects that explain a campaign as well in place of the named one.
//!
//! What is likelier and what these data can tell apart are two things: the evidence names the simplest that fits, and a
//! twin that fits as well is listed beside it, whatever its parameters cost.

use rayon::prelude::*;

use super::candidate::{Candidate, try_effects};
use super::design::{Alternative, Place};
use super::experiment::Experiment;
use super::explain::absent;
use super::fit::{Fit, refine};
use super::jacobian::square_sum;
use super::scan::Effort;
use super::starts::{scaled, with_extreme_shapes};
use crate::effects::{AddedEffect, Effect};
use crate::model::Model;

/// Likelihood ratio by which an alternative has to be worse to be told apart.
pub const TOLD_APART: f64 = 10.0;

/// Angle between two signatures under which the one is worth a fit in place of the other, degree.
const ALIKE_DEG: f64 = 37.0;

/// Where a signature changes its form with its size, a third of the typical one is tried as well.
const SMALL: f64 = 0.3;

/// Angle up to which an effect without the shape of its own is the named one, if they have a size in common: a friction
/// without its breakaway peak is plain friction, and no other explanation. A check valve that takes a steady pressure
/// is one, though a lift valve that passes less looks the same.
const SAME_DEG: f64 = 2.0;

/// Effects that fit as well in place of the last one.
pub(super) fn twins(
    experiment: &Experiment,
    model: &Model,
    whole: &Fit,
    inflation: f64,
) -> Vec<Alternative> {
    let last = whole.estimate.effects.len() - 1;
    let Some(place) = Place::new(experiment, model, whole) else {
        return Vec::new();
    };
    let base_estimate = whole.estimate.without(last);
    let variance = (square_sum(&whole.residuals) / whole.weights.count() as f64).max(1.0);
    let alike: Vec<&'static dyn Effect> = absent(model, &whole.estimate)
        .into_par_iter()
        .filter(|effect| {
            let typical = AddedEffect::typical(*effect);
            let extreme = with_extreme_shapes(&typical);
            let small = scaled(&typical, SMALL);
            [typical]
                .iter()
                .chain(&extreme)
                .chain([&small])
                .any(|form| place.angle_deg(form) < ALIKE_DEG)
        })
        .collect();
    if alike.is_empty() {
        return Vec::new();
    }
    let own_size = size_key(&whole.estimate.effects[last]);
    let own_parameters = whole.estimate.effects[last].values.len() as f64;
    let base = refine(experiment, model, base_estimate);
    try_effects(experiment, model, &base, &alike, Effort::Quick, &|_| {})
        .into_iter()
        .filter_map(|swapped| {
            let better = (whole.cost - swapped.fit.cost) / (variance * inflation);
            let spared = own_parameters - swapped.effect.parameters().len() as f64;
            let merit = |spared: f64| spared * swapped.effective_samples().ln();
            // Fewer parameters are a merit; more are no fault in what cannot be told apart.
            let plain = plain(&swapped).filter(|plain| size_key(plain) == own_size);
            let alike = better + merit(spared.max(0.0)) > -TOLD_APART
                && plain.is_none_or(|plain| place.angle_deg(&plain) > SAME_DEG);
            alike.then_some((better + merit(spared), swapped.fit))
        })
        .filter_map(|(likelier, fit)| Alternative::new(experiment, model, whole, (fit, likelier)))
        .collect()
}

/// What the size of an effect is called in a model file.
fn size_key(added: &AddedEffect) -> &'static str {
    added.effect.parameters()[0].key
}

/// A candidate's effect without the shape of its own, `None` if it has none.
fn plain(candidate: &Candidate) -> Option<AddedEffect> {
    let mut plain = candidate.fit.estimate.effects.last()?.clone();
    let parameters = plain.effect.parameters();
    for (value, parameter) in plain.values.iter_mut().zip(parameters).skip(1) {
        if (parameter.low..=parameter.high).contains(&parameter.null) {
            *value = parameter.null;
        }
    }
    (parameters.len() > 1).then_some(plain)
}
