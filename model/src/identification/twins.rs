//! Effects that explain a campaign as well in place of the named one.
//!
//! What is likelier and what these data can tell apart are two things: the evidence names the simplest that fits, and a
//! twin that fits as well is listed beside it, whatever its parameters cost.

use std::collections::HashSet;

use rayon::prelude::*;

use super::design::{Alternative, Place};
use super::estimate::Estimate;
use super::experiment::Experiment;
use super::explain::showing;
use super::fit::{Fit, refine, sketch};
use super::shortlist::may_catch_up;
use super::starts::{scaled, with_extreme_shapes};
use super::trials::rarity;
use crate::effects::{AddedEffect, Effect};
use crate::model::Model;

/// Likelihood ratio by which an alternative has to be worse to be told apart.
pub const TOLD_APART: f64 = 10.0;

/// Angle between two signatures under which the one is worth a fit in place of the other, degree.
const ALIKE_DEG: f64 = 37.0;

/// What the one may leave of the other at such an angle, sigmas: the more an effect explains, the nearer another has to
/// come before a fit closes the gap. None of 49 that left more came near in a sketch.
const LEFT_SIGMA: f64 = 1.8;

/// Angle of its typical shape from which no extreme one of an effect is like another either, degree.
const UNLIKE_DEG: f64 = 70.0;

/// Where a signature changes its form with its size, a third of the typical one is tried as well.
const SMALL: f64 = 0.3;

/// Angle up to which an effect without the shape of its own is the named one, if they have a size in common: a friction
/// without its breakaway peak is plain friction, and no other explanation. A check valve that takes a steady pressure
/// is one, though a lift valve that passes less looks the same.
const SAME_DEG: f64 = 2.0;

/// Effects that fit as well in place of the last one, whose variance is inflated by so much, but for those that are
/// known to be `unlike` it.
///
/// Each starts from the fit itself, with as much of it in the named effect's place as looks most like that.
pub(super) fn twins(
    experiment: &Experiment,
    model: &Model,
    (whole, inflation): (&Fit, f64),
    unlike: &[&str],
) -> Vec<Alternative> {
    let drafted = experiment.drafted(model, &whole.estimate);
    let Some(place) = Place::new(&drafted, model, whole) else {
        return Vec::new();
    };
    let without = whole.cost + place.explained();
    let seen_sigma = (place.explained() / whole.weights.count() as f64).sqrt();
    let alike_deg = (LEFT_SIGMA / seen_sigma).min(1.0).asin().to_degrees();
    let alike_deg = alike_deg.min(ALIKE_DEG);
    let swapped: Vec<Fit> = showing(experiment, model, &whole.estimate)
        .into_par_iter()
        .filter(|effect| !unlike.contains(&effect.id()))
        .filter_map(|effect| start(&place, whole, effect, alike_deg))
        .map(|start| sketch(&drafted, model, &whole.weights, start, false))
        .filter(|found| may_catch_up(found, without, whole.cost))
        .map(|found| refine(experiment, model, found.estimate))
        .collect();
    let compared = whole.weights.count() as f64;
    let variance = whole.variance();
    let mut twins: Vec<(f64, Fit)> = swapped
        .into_iter()
        .filter_map(|fit| {
            let (own, other) = (last(whole)?, last(&fit)?);
            let better = (whole.cost - fit.cost) / (variance * inflation);
            let spared = own.values.len() as f64 - other.values.len() as f64;
            let merit = |spared: f64| spared * (compared / inflation).ln();
            let rarer = rarity([other]) - rarity([own]);
            // Fewer parameters are a merit; more are no fault in what cannot be told apart.
            let plain = plain(other).filter(|plain| size_key(plain) == size_key(own));
            let alike = better + merit(spared.max(0.0)) > -TOLD_APART
                && plain.is_none_or(|plain| place.angle_deg(&plain) > SAME_DEG);
            alike.then_some((better + merit(spared) - rarer, fit))
        })
        .collect();
    twins.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut named = HashSet::new();
    twins
        .into_iter()
        .filter(|(_, fit)| last(fit).is_some_and(|added| named.insert(added.effect.id())))
        .filter_map(|(likelier, fit)| Alternative::new(experiment, model, whole, (fit, likelier)))
        .collect()
}

fn last(fit: &Fit) -> Option<&AddedEffect> {
    fit.estimate.effects.last()
}

/// A fit with another effect in the place of its last one, in the form and size most like it; `None` if it is like it
/// to less than an angle in none.
fn start(
    place: &Place,
    whole: &Fit,
    effect: &'static dyn Effect,
    alike_deg: f64,
) -> Option<Estimate> {
    let size = &effect.parameters()[0];
    let likened = |form: AddedEffect| {
        let (angle_deg, share) = place.likeness(&form);
        let mut alike = scaled(&form, share);
        alike.values[0] = alike.values[0].clamp(size.low, size.high);
        (angle_deg, alike)
    };
    let nearest = |forms: Vec<AddedEffect>| {
        let likened = forms.into_iter().map(likened);
        likened.min_by(|a, b| a.0.total_cmp(&b.0))
    };
    let typical = AddedEffect::typical(effect);
    let mut best = nearest(vec![typical.clone(), scaled(&typical, SMALL)])?;
    if best.0 < UNLIKE_DEG
        && let Some(extreme) = nearest(with_extreme_shapes(&typical))
        && extreme.0 < best.0
    {
        best = extreme;
    }
    let (angle_deg, alike) = best;
    let worth_a_try = angle_deg < alike_deg && !alike.is_null();
    let mut estimate = whole.estimate.clone();
    *estimate.effects.last_mut()? = alike;
    worth_a_try.then_some(estimate)
}

/// What the size of an effect is called in a model file.
fn size_key(added: &AddedEffect) -> &'static str {
    added.effect.parameters()[0].key
}

/// An effect without the shape of its own, `None` if it has none.
fn plain(added: &AddedEffect) -> Option<AddedEffect> {
    let mut plain = added.clone();
    let parameters = plain.effect.parameters();
    for (value, parameter) in plain.values.iter_mut().zip(parameters).skip(1) {
        if (parameter.low..=parameter.high).contains(&parameter.null) {
            *value = parameter.null;
        }
    }
    (parameters.len() > 1).then_some(plain)
}
