//! Sensitivities for intervals: differences both ways.
//!
//! To descend, a quotient one way will do. An interval hangs on what is left of a column when all others are taken out,
//! and of parameters that all but imitate each other (how much a hose takes up, what share of it creeps and how fast)
//! only hundredths are left. The error of a quotient one way is as large, half the step times the curvature, and no other
//! column imitates it: it counts as information that is not there, and the interval comes out too narrow. Both ways
//! the curvature drops out (Nocedal & Wright 2006, ch. 8.1), so the way may be longer and no single sample decides.

use hitch_plant::{Model, SizeResponse};
use rayon::prelude::*;

use crate::data::experiment::Experiment;
use crate::estimate::Shared;
use crate::estimation::fit::Fit;
use crate::estimation::jacobian::{Jacobian, difference, huber_residuals};

/// Step to either side, as a share of the parameter, or of its scale if that is more.
const STEP: f64 = 0.01;

/// The Jacobian with the columns of the last effect's parameters taken both ways, as far as their ranges let them.
///
/// What is met at a place is left as it is: there a longer way meets something else.
pub(crate) fn both_ways(
    experiment: &Experiment,
    model: &Model,
    fit: &Fit,
    mut jacobian: Jacobian,
) -> Jacobian {
    let last = fit.estimate.effects.len() - 1;
    let smooth = |shared: Shared| {
        matches!(shared, Shared::Effect(effect, _) if effect == last)
            && matches!(
                fit.estimate.size_response(shared),
                SizeResponse::Smooth | SizeResponse::Stepped
            )
    };
    let columns: Vec<(usize, Vec<Vec<f64>>)> = jacobian
        .shared
        .par_iter()
        .enumerate()
        .filter(|&(_, &shared)| smooth(shared))
        .map(|(column, &shared)| (column, quotient(experiment, model, fit, shared)))
        .collect();
    for (column, quotients) in columns {
        for (run, quotient) in jacobian.runs.iter_mut().zip(quotients) {
            run.shared[column] = quotient;
        }
    }
    jacobian
}

/// Change of the simulation a step of one scale.
fn quotient(experiment: &Experiment, model: &Model, fit: &Fit, shared: Shared) -> Vec<Vec<f64>> {
    let (value, scale) = (fit.estimate.get(shared), fit.estimate.scale(shared));
    let step = STEP * value.abs().max(scale);
    let [below, above] = [-step, step].map(|step| {
        let mut moved = fit.estimate.clone();
        moved.set(shared, value + step);
        moved
    });
    let taken = (above.get(shared) - below.get(shared)) / scale;
    let left = |estimate| huber_residuals(experiment, model, &fit.weights, estimate);
    // The residual falls where the simulation rises.
    let mut change = difference(&left(&below), &left(&above));
    for sample in change.iter_mut().flatten() {
        *sample /= taken;
    }
    change
}
