//! Bounded Levenberg-Marquardt over the corrections of the constants and each run's load error.

use nalgebra::{DMatrix, DVector};

use crate::base::normal::{BaseProblem, Normal, Point};
use crate::residuals::whitening::Weights;

/// Number of damping values tried for one step, the first of a descent, and the factor from one to the next.
const TRIES: usize = 5;
const FIRST_DAMPING: f64 = 1e-3;
const DAMPING_FACTOR: f64 = 20.0;

/// Smallest relative reduction of the cost that justifies another step.
const WORTHWHILE: f64 = 1e-6;

/// Descends from `start` under given weights with at most `jacobians` Jacobians.
pub fn descend(
    problem: &BaseProblem<'_>,
    weights: &Weights,
    start: &Point,
    jacobians: usize,
) -> Point {
    let mut point = problem.point(weights, start.theta.clone(), start.estimate.clone());
    let mut damping = FIRST_DAMPING;
    for _ in 0..jacobians {
        let Some(columns) = problem.columns(weights, &point) else {
            break;
        };
        let normal = Normal::of(&columns);
        let before = point.cost;
        let tries = std::iter::successors(Some(damping), |d| Some(DAMPING_FACTOR * d)).take(TRIES);
        for tried in tries {
            let Some(moved) = step(problem, weights, &normal, &point, tried) else {
                continue;
            };
            if moved.cost < point.cost {
                point = moved;
                damping = (0.1 * tried).max(1e-9);
                break;
            }
        }
        if before - point.cost <= WORTHWHILE * before {
            break;
        }
    }
    point
}

/// The end of a damped step. Unknowns that would leave their range are fixed, and the others are solved without them.
fn step(
    problem: &BaseProblem<'_>,
    weights: &Weights,
    normal: &Normal,
    point: &Point,
    damping: f64,
) -> Option<Point> {
    let prior = problem.prior;
    let mut matrix = &normal.matrix + &prior.precision;
    let mut right = &normal.right - &prior.precision * &point.theta;
    for k in 0..matrix.nrows() {
        matrix[(k, k)] += damping * matrix[(k, k)];
    }
    for k in (0..problem.held.len()).filter(|&k| problem.held[k]) {
        hold(&mut matrix, &mut right, k);
    }
    let at_an_end: Vec<usize> = (0..point.theta.len())
        .filter(|&k| prior.is_at_an_end(&point.theta, k))
        .collect();
    let first = matrix.clone().cholesky()?.solve(&right);
    for k in at_an_end {
        if first[k] * point.theta[k] > 0.0 {
            hold(&mut matrix, &mut right, k);
        }
    }
    let step: DVector<f64> = matrix.cholesky()?.solve(&right);
    let theta = prior.bounded(&(&point.theta + &step));
    let taken = &theta - &point.theta;
    let estimate = normal.with_loads(&point.estimate, &taken);
    Some(problem.point(weights, theta, estimate))
}

/// Removes an unknown from the normal equations: its step is zero.
fn hold(matrix: &mut DMatrix<f64>, right: &mut DVector<f64>, unknown: usize) {
    matrix.row_mut(unknown).fill(0.0);
    matrix.column_mut(unknown).fill(0.0);
    matrix[(unknown, unknown)] = 1.0;
    right[unknown] = 0.0;
}
