//! Effects weighed beside all others that a fitted model has.
//!
//! An effect that is weighed as it is added takes on what effects after it stand for: neither its value nor its
//! evidence is what is left of them once those are there too.

use hitch_plant::Model;

use crate::data::experiment::Experiment;
use crate::estimation::fit::{Fit, refine, with_last};
use crate::selection::candidate::{Candidate, weigh};

/// An effect beside all others.
#[derive(Debug, Clone)]
pub struct LeaveOneOut {
    /// The effect, weighed against the model that has all others.
    pub candidate: Candidate,
    /// That model, fitted.
    pub without: Fit,
}

/// Weighs each effect of a fitted model from the `first` one on beside all others.
#[must_use]
pub fn beside(experiment: &Experiment, model: &Model, fit: &Fit, first: usize) -> Vec<LeaveOneOut> {
    let effects = first..fit.estimate.effects.len();
    effects
        .map(|index| beside_others(experiment, model, fit, index))
        .collect()
}

/// Weighs one effect of a fitted model beside all others.
pub(crate) fn beside_others(
    experiment: &Experiment,
    model: &Model,
    fit: &Fit,
    index: usize,
) -> LeaveOneOut {
    let without = refine(experiment, model, fit.estimate.without(index));
    let whole = with_last(experiment, model, fit, index);
    let effect = fit.estimate.effects[index].effect;
    LeaveOneOut {
        candidate: weigh(experiment, model, &without, effect, whole),
        without,
    }
}
