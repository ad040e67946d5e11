//! Forms of effects reconsidered once others are known.
//!
//! While a second effect is missing, that form of the first comes first which takes on most of it: a leak that seems to
//! thin with the oil where a compensator droops too. And what a form lacks shows best once nothing else is missing.

use std::ops::Range;

use rayon::prelude::*;

use super::adequacy::{Cell, adequate, cells_since};
use super::candidate::weigh;
use super::experiment::Experiment;
use super::explain::possible;
use super::fit::{Fit, evaluate, in_place, refine, with_last};
use super::trials::Odds;
use crate::effects::Effect;
use crate::model::Model;

/// Logarithm of the odds by which another form has to be likelier than the one that was found.
const LIKELIER: f64 = 2.0;

/// A fit with each effect from the `first` on in its likeliest form; `None` if each has it already.
///
/// Where the model is adequate, seen from the cells that it had `before`, only forms that say no more are tried.
pub(super) fn reformed(
    experiment: &Experiment,
    model: &Model,
    before: &[Cell],
    fit: &Fit,
    first: usize,
) -> Option<Fit> {
    let cells = cells_since(before, experiment, fit);
    let enough = adequate(experiment, &cells, fit);
    let last = fit.estimate.effects.len() - 1;
    let mut reformed = all_plain(experiment, model, fit, first);
    let once_around = |reformed: Option<Fit>, indices: Range<usize>| {
        indices.fold(reformed, |reformed, index| {
            let present = reformed.as_ref().unwrap_or(fit);
            likelier_form(experiment, model, present, index, enough).or(reformed)
        })
    };
    // The forms of the last one have just been tried. But what one takes back another may have lacked.
    reformed = once_around(reformed, first..last);
    if reformed.is_some() {
        reformed = once_around(reformed, first..last + 1);
    }
    reformed
}

/// The fit with all effects in their plainest forms if that is likelier: two that say more may each stand for what the
/// other has too much of.
fn all_plain(experiment: &Experiment, model: &Model, fit: &Fit, first: usize) -> Option<Fit> {
    let mut start = fit.estimate.clone();
    let mut changed = 0;
    for added in &mut start.effects[first..] {
        let forms = other_forms(model, added.effect, true).into_iter();
        let plainest = forms.min_by_key(|form| plainness(*form));
        if let Some(plainest) = plainest.filter(|form| plainness(*form) < plainness(added.effect)) {
            *added = added.in_form(plainest);
            changed += 1;
        }
    }
    let count = start.effects.len() - first;
    (changed > 1)
        .then(|| refine(experiment, model, start))
        .filter(|plain| {
            let odds = odds(experiment, model, fit);
            odds.of_last(plain, count, plain.cost) > odds.of_last(fit, count, fit.cost) + LIKELIER
        })
}

/// The fit with one effect in another form that is likelier, if there is one; in one that says no more if that is `enough`.
pub(super) fn likelier_form(
    experiment: &Experiment,
    model: &Model,
    fit: &Fit,
    index: usize,
    enough: bool,
) -> Option<Fit> {
    let forms = other_forms(model, fit.estimate.effects[index].effect, enough);
    if forms.is_empty() {
        return None;
    }
    let whole = with_last(experiment, model, fit, index);
    let odds = odds(experiment, model, &whole);
    let best = forms
        .into_par_iter()
        .map(|form| {
            let mut start = whole.estimate.clone();
            if let Some(last) = start.effects.last_mut() {
                *last = last.in_form(form);
            }
            let fit = refine(experiment, model, start);
            (odds.of_last(&fit, 1, fit.cost), fit)
        })
        .max_by(|a, b| a.0.total_cmp(&b.0))?;
    let likelier = best.0 > odds.of_last(&whole, 1, whole.cost) + LIKELIER;
    likelier.then(|| in_place(experiment, model, &best.1, index))
}

/// The odds of fits like one, in the units of its last effect.
fn odds(experiment: &Experiment, model: &Model, fit: &Fit) -> Odds {
    let last = fit.estimate.effects.len() - 1;
    let without = evaluate(experiment, model, fit.estimate.without(last));
    let effect = fit.estimate.effects[last].effect;
    Odds::new(
        &without,
        &weigh(experiment, model, &without, effect, fit.clone()),
    )
}

/// The forms of an effect that the plant can have; those alone that say no more if the present one is `enough`.
fn other_forms(
    model: &Model,
    effect: &'static dyn Effect,
    enough: bool,
) -> Vec<&'static dyn Effect> {
    possible(model)
        .filter(|form| form.id() == effect.id() && form.form() != effect.form())
        .filter(|form| !enough || said(*form) <= said(effect))
        .collect()
}

/// How far from plain a form is: of those that say as much the usual one is.
fn plainness(form: &dyn Effect) -> (usize, bool, bool) {
    let (parameters, refines) = said(form);
    (parameters, refines, form.form().is_some())
}

/// How much a form says of its effect.
pub(super) fn said(form: &dyn Effect) -> (usize, bool) {
    (form.parameters().len(), form.refines())
}
