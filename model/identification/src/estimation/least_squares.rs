//! Bounded Levenberg-Marquardt over effects, clocks and each run's load error.
//!
//! General crates have no bounds and do not exploit the arrow structure of the normal equations (see
//! [`crate::estimation::jacobian`]), with which a fit of 45 parameters costs as much as one of five.
//!
//! A Jacobian takes one simulation per parameter, a step takes one. While steps achieve the predicted reduction, the
//! Jacobian is kept and updated by Broyden's method (Broyden 1965). A descent ends only if a fresh Jacobian predicts no
//! further reduction.

use hitch_plant::SizeResponse;

use crate::data::problem::Problem;
use crate::estimate::{Estimate, Step};
use crate::estimation::jacobian::Jacobian;
use crate::estimation::residual_columns::{huber_residuals, square_sum};
use crate::estimation::slow_columns::SlowColumns;
use crate::residuals::whitening::Weights;

/// Number of Jacobians after which the columns of clocks and loads, which hardly change, are recomputed.
const SLOW_EVERY: usize = 4;

/// Number of damping values tried for one step, the first of a descent, and the factor from one to the next.
const TRIES: usize = 4;
const FIRST_DAMPING: f64 = 1e-3;
const DAMPING_FACTOR: f64 = 30.0;

/// Smallest relative reduction of the cost that justifies another step.
const WORTHWHILE: f64 = 1e-5;

/// Share of the predicted reduction of the cost that a step has to achieve for its Jacobian to be kept, how many times
/// a Jacobian is kept in succession, and fewest effect parameters with which keeping it saves more than it costs in
/// poorer steps.
const KEPT: f64 = 0.5;
const MOST_KEPT: usize = 3;
const WORTH_KEEPING: usize = 4;

/// Result of a descent.
#[derive(Debug, Clone)]
pub struct Descent {
    /// The estimate at its end.
    pub estimate: Estimate,
    /// Sum of the Huber losses plus the cost of the priors.
    pub cost: f64,
    /// Reduction of the cost in the last iteration.
    pub last_reduction: f64,
}

/// Which parameters a descent moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Moves {
    /// All free parameters.
    All,
    /// All but the sizes of switching effects.
    AllButSwitching,
}

/// Descends from `start` under given weights with at most `jacobians` Jacobians.
pub(crate) fn descend(
    problem: Problem<'_>,
    weights: &Weights,
    start: Estimate,
    moves: Moves,
    jacobians: usize,
) -> Descent {
    let problem = LeastSquares {
        problem,
        weights,
        moves,
    };
    let mut point = problem.point(start);
    let mut damping = FIRST_DAMPING;
    let mut slow = None;
    let mut last_reduction = 0.0;
    for made in 0..jacobians {
        if problem.problem.limit.is_over() {
            break;
        }
        if made % slow_every(&point.estimate) == 0 {
            slow = None;
        }
        let columns = slow.take().unwrap_or_else(|| problem.slow_columns(&point));
        let mut jacobian = problem.jacobian(&point, &columns);
        slow = Some(columns);
        let before = point.cost;
        let simulated = jacobian.shared.iter().filter(|shared| !shared.has_prior());
        let most_kept = if simulated.count() >= WORTH_KEEPING {
            MOST_KEPT
        } else {
            0
        };
        for kept in 0..=most_kept {
            let Some(taken) = problem.step(&jacobian, &point, damping) else {
                break;
            };
            damping = (taken.damping * 0.1).max(1e-9);
            let reduction = point.cost - taken.to.cost;
            let brings = reduction >= KEPT * taken.predicted && reduction > WORTHWHILE * point.cost;
            let goes_on = brings && kept < most_kept && !taken.has_switching;
            if goes_on {
                jacobian.correct(&taken.step, &taken.to.residuals, &taken.to.estimate);
            }
            point = taken.to;
            if !goes_on {
                break;
            }
        }
        last_reduction = before - point.cost;
        if last_reduction <= WORTHWHILE * before {
            break;
        }
    }
    Descent {
        estimate: point.estimate,
        cost: point.cost,
        last_reduction,
    }
}

/// Number of Jacobians after which the columns of clocks, loads and constants are recomputed. Flow curves that are free point by
/// point are far from the data at first, and their columns change with each step.
fn slow_every(estimate: &Estimate) -> usize {
    let constants = estimate.constants.as_ref();
    if constants.is_some_and(|constants| constants.free() > 0 && !constants.is_smooth()) {
        1
    } else {
        SLOW_EVERY
    }
}

/// The least-squares problem of a descent.
struct LeastSquares<'a> {
    /// The measured data and the model.
    problem: Problem<'a>,
    weights: &'a Weights,
    moves: Moves,
}

/// An accepted step.
struct AcceptedStep {
    step: Step,
    to: Point,
    damping: f64,
    /// Reduction of the cost that the Jacobian predicted.
    predicted: f64,
    /// Whether the size of a switching effect is free.
    has_switching: bool,
}

impl LeastSquares<'_> {
    fn point(&self, estimate: Estimate) -> Point {
        let residuals = huber_residuals(self.problem, self.weights, &estimate);
        let cost = square_sum(&residuals) + estimate.prior_cost();
        Point {
            estimate,
            residuals,
            cost,
        }
    }

    fn slow_columns(&self, point: &Point) -> SlowColumns {
        SlowColumns::new(
            self.problem,
            self.weights,
            &point.estimate,
            &point.residuals,
        )
    }

    fn jacobian(&self, point: &Point, slow: &SlowColumns) -> Jacobian {
        let (problem, weights) = (self.problem, self.weights);
        let (estimate, residuals) = (&point.estimate, &point.residuals);
        Jacobian::with_slow_columns(problem, weights, estimate, residuals, slow)
    }

    /// The first step, by increasing damping, that reduces the cost.
    fn step(&self, jacobian: &Jacobian, point: &Point, damping: f64) -> Option<AcceptedStep> {
        // The slope of a switching effect says little about the result of a finite step.
        let is_switching = |shared| point.estimate.size_response(shared) == SizeResponse::Switching;
        let has_switching = jacobian.shared.iter().any(|&shared| is_switching(shared));
        let is_held = |shared| self.moves == Moves::AllButSwitching && is_switching(shared);
        dampings(damping).find_map(|damping| {
            let step = jacobian.step(&point.estimate, damping, is_held)?;
            let moved = point.estimate.moved(&jacobian.shared, &step);
            let step = moved.step_from(&point.estimate, &jacobian.shared);
            let predicted = point.cost - jacobian.predicted_square_sum(&step) - moved.prior_cost();
            let to = self.point(moved);
            (to.cost < point.cost).then_some(AcceptedStep {
                step,
                to,
                damping,
                predicted,
                has_switching,
            })
        })
    }
}

/// The damping values to try, in order.
fn dampings(first: f64) -> impl Iterator<Item = f64> {
    std::iter::successors(Some(first), |&damping| Some(DAMPING_FACTOR * damping)).take(TRIES)
}

/// An estimate with its residuals and cost.
struct Point {
    estimate: Estimate,
    residuals: Vec<Vec<f64>>,
    cost: f64,
}
