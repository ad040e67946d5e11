//! Effects weighed beside all others that a fitted model has.
//!
//! An effect that is weighed as it is added takes on what effects after it stand for: neither its value nor its
//! evidence is what is left of them once those are there too.

use super::candidate::{Candidate, weigh};
use super::experiment::Experiment;
use super::fit::{Fit, refine, with_last};
use crate::model::Model;

/// An effect beside all others.
#[derive(Debug, Clone)]
pub struct Beside {
    /// The effect, weighed against the model that has all others.
    pub candidate: Candidate,
    /// Error of that model, in sigma.
    pub error_without: f64,
}

/// Weighs each effect of a fitted model from the `first` one on beside all others.
#[must_use]
pub fn beside(experiment: &Experiment, model: &Model, fit: &Fit, first: usize) -> Vec<Beside> {
    let effects = fit.estimate.effects.iter().enumerate().skip(first);
    effects
        .map(|(index, added)| {
            let without = refine(experiment, model, fit.estimate.without(index));
            let whole = with_last(experiment, model, fit, index);
            Beside {
                error_without: without.error(),
                candidate: weigh(experiment, model, &without, added.effect, whole),
            }
        })
        .collect()
}
