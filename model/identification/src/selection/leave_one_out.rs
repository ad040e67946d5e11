//! Leave-one-out evaluation of the effects of a fitted model.
//!
//! An effect that is weighed when it is added absorbs part of the effects added later: neither its value nor its
//! evidence is final.

use crate::data::problem::Problem;
use crate::estimation::fit::{Fit, evaluate, refine};
use crate::selection::candidate::{Candidate, weigh};

/// An effect weighed against the model with all other effects.
#[derive(Debug, Clone)]
pub struct LeaveOneOut {
    /// The weighed effect.
    pub candidate: Candidate,
    /// The model with all other effects, fitted.
    pub without: Fit,
}

/// Weighs each effect of a fitted model, from the `first` one on, against the model with all others.
#[must_use]
pub fn leave_one_out(problem: Problem<'_>, fit: &Fit, first: usize) -> Vec<LeaveOneOut> {
    let whole = evaluate(problem, fit.estimate.clone());
    let effects = first..fit.estimate.effects.len();
    effects
        .map(|index| leave_one_out_of(problem, &whole, index))
        .collect()
}

/// Weighs one effect of an evaluated model against the model with all others.
fn leave_one_out_of(problem: Problem<'_>, whole: &Fit, index: usize) -> LeaveOneOut {
    let without = refine(problem, whole.estimate.without(index));
    LeaveOneOut {
        candidate: weigh(problem, &without, whole.clone(), index),
        without,
    }
}
