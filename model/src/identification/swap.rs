//! What is likelier in the place of an effect that was named early.
//!
//! While a later effect was missing, the one that could take on a little of it came first. Once all are named, what
//! explains the campaign better in its place takes that.

use super::design::Alternative;
use super::experiment::Experiment;
use super::explain::{Step, restate};
use super::fit::{Fit, in_place};
use super::forms::likelier_form;
use super::shortlist::CLOSE;
use crate::model::Model;

/// Likelihood ratio by which an alternative has to be better to take the named effect's place, and how often one may.
const LIKELIER: f64 = 2.0;
pub(super) const MOST_SWAPS: usize = 3;

/// Whether an alternative has to take the named effect's place.
pub(super) fn is_likelier(alternative: &Alternative) -> bool {
    alternative.likelier > LIKELIER
}

/// Puts what is likelier now in the place of one of some steps, or a form of its own that explains as much. Returns the
/// model after all steps; `None` if there is nothing to put.
pub(super) fn swap(
    experiment: &Experiment,
    model: &Model,
    after: &Fit,
    (given, index): (usize, usize),
    steps: &mut [Step],
) -> Option<Fit> {
    let alternatives = std::mem::take(&mut steps[index].indistinguishable).into_iter();
    let best = alternatives.max_by(|a, b| a.likelier.total_cmp(&b.likelier))?;
    // A form that says more has to be likelier than what the named effect's own forms say.
    let own = (best.effect.refines())
        .then(|| likelier_form(experiment, model, after, given + index, false))
        .flatten()
        .filter(|own| own.cost < best.fit.cost + CLOSE);
    let after = own.unwrap_or_else(|| in_place(experiment, model, &best.fit, given + index));
    steps[index].unlike.clear();
    restate(experiment, model, &after, given, steps);
    Some(after)
}
