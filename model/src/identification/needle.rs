//! The size of what jumps, once all else is right.
//!
//! The size of a spool that sticks is known to a few hundredths of a percent or not at all: a little beside, and the
//! tenth jump comes at another time. Slopes lead nowhere there, and while the clocks still stood in for what was missing
//! a look through all sizes met the valley a little off. With a fit beside it the last step is a fine search.

use rayon::prelude::*;

use super::experiment::Experiment;
use super::fit::{Fit, evaluate_weighted, refine};
use super::starts::scaled;
use crate::effects::Search;
use crate::model::Model;

/// How far to either side sizes are tried, as a share, and how many.
const REACHES: [f64; 2] = [0.005, 0.000_8];
const TO_EITHER_SIDE: i32 = 10;

/// The better of a fit and of the ones that the sizes of its last effect nearby lead to, if that jumps.
pub(super) fn threaded(experiment: &Experiment, model: &Model, fit: Fit) -> Fit {
    let last = fit.estimate.effects.last();
    if last.is_none_or(|added| added.effect.search() != Search::Jumps || added.is_null()) {
        return fit;
    }
    REACHES.iter().fold(fit, |fit, &reach| {
        let nearby = nearby(experiment, model, &fit, reach);
        if nearby.cost < fit.cost {
            let refined = refine(experiment, model, nearby.estimate.clone());
            [fit, nearby, refined]
                .into_iter()
                .min_by(|a, b| a.cost.total_cmp(&b.cost))
                .expect("there are three")
        } else {
            fit
        }
    })
}

/// The best of the sizes nearby, all else as it is.
fn nearby(experiment: &Experiment, model: &Model, fit: &Fit, reach: f64) -> Fit {
    let sizes = (-TO_EITHER_SIDE..=TO_EITHER_SIDE).into_par_iter();
    sizes
        .map(|step| {
            let mut estimate = fit.estimate.clone();
            if let Some(last) = estimate.effects.last_mut() {
                *last = scaled(
                    last,
                    1.0 + reach * f64::from(step) / f64::from(TO_EITHER_SIDE),
                );
            }
            evaluate_weighted(experiment, model, estimate, fit.weights.clone())
        })
        .min_by(|a, b| a.cost.total_cmp(&b.cost))
        .expect("there are sizes")
}
