//! Bounded Levenberg-Marquardt over the corrections of the constants, the clock offsets and each run's load error.

use nalgebra::DVector;

use crate::base::normal::{BaseProblem, Normal, Point};
use crate::estimation::jacobian::hold;
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
    let precision = problem.precision(&problem.prior.precision);
    let present = problem.unknowns(point);
    let (information, gradient) = normal.reduced(damping);
    let mut matrix = information + &precision;
    let mut right = gradient - &precision * &present;
    for k in 0..matrix.nrows() {
        matrix[(k, k)] += damping * matrix[(k, k)];
    }
    let fixed = problem.fixed(point);
    for k in (0..fixed.len()).filter(|&k| fixed[k]) {
        hold(&mut matrix, &mut right, k);
    }
    let first = matrix.clone().cholesky()?.solve(&right);
    for k in (0..fixed.len()).filter(|&k| problem.is_at_an_end(point, k)) {
        if first[k] * present[k] > 0.0 {
            hold(&mut matrix, &mut right, k);
        }
    }
    let step: DVector<f64> = matrix.cholesky()?.solve(&right);
    let (theta, estimate) = problem.within_ranges(&(&present + step), &point.estimate);
    let moved = Point {
        theta,
        estimate,
        cost: f64::INFINITY,
    };
    let taken = problem.unknowns(&moved) - present;
    let estimate = normal.with_loads(&moved.estimate, &taken, damping);
    Some(problem.point(weights, moved.theta, estimate))
}
