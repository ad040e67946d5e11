//! Central differences for confidence intervals.
//!
//! A forward difference is accurate enough for a descent. A confidence interval depends on the part of a column that is
//! orthogonal to all other columns. For nearly collinear parameters (compliance of a hose, its creeping share and its
//! time constant) only hundredths remain. The error of a forward difference, half the step times the curvature, is as
//! large and not collinear with any column, so it counts as information and makes the interval too narrow. Central
//! differences cancel the curvature (Nocedal & Wright 2006, ch. 8.1). They allow a longer step, so that no single
//! sample dominates.

use hitch_plant::SizeResponse;

use crate::data::problem::Problem;
use crate::estimate::Shared;
use crate::estimation::fit::Fit;
use crate::estimation::jacobian::Jacobian;
use crate::estimation::residual_columns::central_quotients;
use crate::parallel;

/// Step to either side, as a share of the parameter's value, or of its scale if that is larger.
const STEP: f64 = 0.01;

/// The Jacobian with the columns of an effect's parameters replaced by central differences, within their ranges.
///
/// Columns of switching and located sizes stay as they are: a longer step would cross other events.
pub(crate) fn with_central_differences(
    problem: Problem<'_>,
    fit: &Fit,
    mut jacobian: Jacobian,
    index: usize,
) -> Jacobian {
    let estimate = &fit.estimate;
    let smooth = |shared: Shared| {
        matches!(shared, Shared::Effect(effect, _) if effect == index)
            && matches!(
                estimate.size_response(shared),
                SizeResponse::Smooth | SizeResponse::Stepped
            )
    };
    let shared = jacobian.shared.iter().enumerate();
    let shared = shared.filter(|&(_, &shared)| smooth(shared));
    let columns: Vec<(usize, Vec<Vec<f64>>)> = parallel::map(shared, |(column, &shared)| {
        let size = estimate.get(shared).abs().max(estimate.scale(shared));
        let step = STEP * size;
        let quotients = central_quotients(problem, &fit.weights, estimate, shared, step);
        (column, quotients)
    });
    for (column, quotients) in columns {
        for (run, quotient) in jacobian.runs.iter_mut().zip(quotients) {
            run.shared[column] = quotient;
        }
    }
    jacobian
}
