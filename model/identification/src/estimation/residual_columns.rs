//! The residuals of an estimate, and columns of their changes.

use crate::data::problem::Problem;
use crate::estimate::{Estimate, Shared};
use crate::parallel;
use crate::residuals::whitening::Weights;

/// Threshold of Huber's loss, in sigmas: beyond it the loss grows linearly instead of quadratically.
const HUBER_THRESHOLD: f64 = 10.0;

/// Whitened residuals of every run under an estimate.
#[must_use]
pub fn residuals(problem: Problem<'_>, weights: &Weights, estimate: &Estimate) -> Vec<Vec<f64>> {
    let Problem {
        experiment, model, ..
    } = problem;
    let model = estimate.applied_to(model);
    parallel::map(0..experiment.runs.len(), |index| {
        let run = &experiment.runs[index];
        let trace = run.simulate(&model, estimate.nuisances[index], &estimate.clocks);
        weights.runs[index].whiten(run, &trace)
    })
}

/// Residuals transformed such that their squares are Huber losses.
///
/// While an effect is missing, a simulation may run against a stop that the real hitch never reached. A thousand sigmas
/// of dead-head pressure would then dominate the cost. Residuals below `HUBER_THRESHOLD` are unchanged.
#[must_use]
pub fn huber(mut residuals: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    for residual in residuals.iter_mut().flatten() {
        let size = residual.abs();
        if size > HUBER_THRESHOLD {
            *residual = (2.0 * HUBER_THRESHOLD * size - HUBER_THRESHOLD * HUBER_THRESHOLD)
                .sqrt()
                .copysign(*residual);
        }
    }
    residuals
}

/// [`residuals`] transformed by [`huber`].
#[must_use]
pub fn huber_residuals(
    problem: Problem<'_>,
    weights: &Weights,
    estimate: &Estimate,
) -> Vec<Vec<f64>> {
    huber(residuals(problem, weights, estimate))
}

/// Sum of squares of residuals.
#[must_use]
pub fn square_sum(residuals: &[Vec<f64>]) -> f64 {
    residuals.iter().map(|run| dot(run, run)).sum()
}

/// Dot product, with eight partial sums: floating-point addition is not associative, so a single sum could not be
/// vectorised.
#[must_use]
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    let (a_parts, a_rest) = a.as_chunks::<8>();
    let (b_parts, b_rest) = b.as_chunks::<8>();
    let mut sums = [0.0; 8];
    for (a, b) in a_parts.iter().zip(b_parts) {
        for lane in 0..8 {
            sums[lane] += a[lane] * b[lane];
        }
    }
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum();
    sums.iter().sum::<f64>() + rest
}

/// Residuals `a` minus `b`, run by run.
#[must_use]
pub fn difference(a: &[Vec<f64>], b: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let runs = a.iter().zip(b);
    runs.map(|(a, b)| a.iter().zip(b).map(|(a, b)| a - b).collect())
        .collect()
}

/// Subtracts `share` times `part` from `column`.
pub fn subtract(column: &mut [f64], share: f64, part: &[f64]) {
    for (value, part) in column.iter_mut().zip(part) {
        *value -= share * part;
    }
}

/// Change of a run's simulation per step of one scale: the residual decreases where the simulation increases.
pub(crate) fn quotient(base: &[f64], mut moved: Vec<f64>, step: f64) -> Vec<f64> {
    for (m, b) in moved.iter_mut().zip(base) {
        *m = (b - *m) / step;
    }
    moved
}

/// [`quotient`] of every run.
pub(super) fn quotients(base: &[Vec<f64>], moved: Vec<Vec<f64>>, step: f64) -> Vec<Vec<f64>> {
    let runs = base.iter().zip(moved);
    runs.map(|(base, moved)| quotient(base, moved, step))
        .collect()
}

/// The same between `step` below and above an estimate, in the unit of the parameter, within its range. The curvature
/// cancels. Zero where the parameter cannot move.
pub(super) fn central_quotients(
    problem: Problem<'_>,
    weights: &Weights,
    estimate: &Estimate,
    parameter: Shared,
    step: f64,
) -> Vec<Vec<f64>> {
    let side = |step: f64| {
        let mut moved = estimate.clone();
        moved.set(parameter, estimate.get(parameter) + step);
        let residuals = huber_residuals(problem, weights, &moved);
        (moved.get(parameter), residuals)
    };
    let ((low, below), (high, above)) = rayon::join(|| side(-step), || side(step));
    if high > low {
        quotients(&below, above, (high - low) / estimate.scale(parameter))
    } else {
        below.iter().map(|run| vec![0.0; run.len()]).collect()
    }
}
