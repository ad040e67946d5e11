//! Sensitivities of the whitened residuals, and the normal equations with each run's load error eliminated.
//!
//! Every run has a load error of its own, so the normal matrix has arrow structure: shared parameters couple all runs,
//! a load error affects only its own run. Eliminating the load errors run by run (Schur complement) leaves a system of
//! the size of the shared parameters. Its columns are the projected signatures, orthogonal to the load columns.

use hitch_plant::SizeResponse;
use nalgebra::{DMatrix, DVector};

use crate::data::problem::Problem;
use crate::estimate::{Estimate, Shared, Step};
use crate::estimation::gram::Gram;
use crate::estimation::residual_columns::{dot, huber_residuals, quotients, subtract};
use crate::estimation::slow_columns::SlowColumns;
use crate::parallel;
use crate::residuals::whitening::Weights;

/// Step of a difference quotient, as a share of the parameter's value, or of its scale if that is larger.
const STEP: f64 = 0.02;

/// The same for parameters with a short range of linearity. A frequency that is one percent lower lags a third of a
/// radian after five periods, so a longer secant no longer approximates the slope. A hitch standing on the ground loses
/// contact if the ground is millimetres lower.
const FINE_STEP: f64 = 0.002;

/// One run's residuals and their sensitivities per step of one scale.
#[derive(Debug, Clone)]
pub struct RunJacobian {
    /// Whitened residuals.
    pub residual: Vec<f64>,
    /// Whitened change of the simulation, one column per shared parameter.
    pub shared: Vec<Vec<f64>>,
    /// Column of the load error. `None` on a flow bench, and at an end of its range if the gradient points outwards: a
    /// parameter that cannot move absorbs nothing.
    pub load: Option<Vec<f64>>,
    /// Present load error, in prior sigmas.
    pub load_value: f64,
}

/// Sensitivities of all runs.
#[derive(Debug, Clone)]
pub struct Jacobian {
    /// A block for each run.
    pub runs: Vec<RunJacobian>,
    /// The shared parameters, in the order of the columns.
    pub shared: Vec<Shared>,
}

/// Sensitivity of all runs to one shared parameter.
fn shared_column(
    problem: Problem<'_>,
    weights: &Weights,
    estimate: &Estimate,
    base: &[Vec<f64>],
    parameter: Shared,
) -> Vec<Vec<f64>> {
    let Problem { experiment, .. } = problem;
    let (value, scale) = (estimate.get(parameter), estimate.scale(parameter));
    let step = match estimate.size_response(parameter) {
        SizeResponse::Located => FINE_STEP * scale,
        SizeResponse::Smooth if experiment.ringing => FINE_STEP * value.abs().max(scale),
        SizeResponse::Smooth | SizeResponse::Switching | SizeResponse::Stepped => {
            STEP * value.abs().max(scale)
        }
    };
    let mut moved = estimate.clone();
    moved.set(parameter, value + step);
    if moved.get(parameter) == value {
        moved.set(parameter, value - step);
    }
    let taken = (moved.get(parameter) - value) / scale;
    quotients(base, huber_residuals(problem, weights, &moved), taken)
}

impl Jacobian {
    /// Difference quotients at `estimate`, for all shared parameters and each run's load.
    #[must_use]
    pub fn new(problem: Problem<'_>, weights: &Weights, estimate: &Estimate) -> Self {
        let base = huber_residuals(problem, weights, estimate);
        let slow = SlowColumns::new(problem, weights, estimate, &base);
        Self::with_slow_columns(problem, weights, estimate, &base, &slow)
    }

    /// The same with given residuals, and with the columns of clocks and loads from a nearby estimate.
    #[must_use]
    pub fn with_slow_columns(
        problem: Problem<'_>,
        weights: &Weights,
        estimate: &Estimate,
        base: &[Vec<f64>],
        slow: &SlowColumns,
    ) -> Self {
        let Problem { experiment, .. } = problem;
        let shared = estimate.shared();
        let free = shared.iter().filter(|parameter| !parameter.has_prior());
        let columns = parallel::map(free, |&parameter| {
            shared_column(problem, weights, estimate, base, parameter)
        });
        let runs = (0..base.len())
            .map(|run| RunJacobian {
                residual: base[run].clone(),
                shared: columns
                    .iter()
                    .map(|column| column[run].clone())
                    .chain(slow.clocks.iter().map(|clock| clock[run].clone()))
                    .chain(slow.constants.iter().map(|column| column[run].clone()))
                    .collect(),
                load: (experiment.runs[run].on_hitch()
                    && !estimate.load_would_leave(run, dot(&slow.loads[run], &base[run])))
                .then(|| slow.loads[run].clone()),
                load_value: estimate.load(run),
            })
            .collect();
        Self { runs, shared }
    }

    /// Gram matrix of shared parameters, by their columns, and of further columns, by run: load errors eliminated run by run,
    /// priors included, and the first `eliminated` shared parameters eliminated. `residuals` are those of each run.
    #[must_use]
    pub fn gram(
        &self,
        estimate: &Estimate,
        (shared, eliminated): (&[usize], usize),
        further: &[&[Vec<f64>]],
        residuals: &[&[f64]],
    ) -> Gram {
        let of_run = |(index, run): (usize, &RunJacobian)| {
            let shared = shared.iter().map(|&column| run.shared[column].as_slice());
            let further = further.iter().map(|column| column[index].as_slice());
            let columns = shared.chain(further).chain([residuals[index]]);
            run.products(&columns.collect::<Vec<&[f64]>>())
        };
        let runs = parallel::map(self.runs.iter().enumerate(), of_run);
        let last = shared.len() + further.len();
        let mut whole: DMatrix<f64> = DMatrix::zeros(last + 1, last + 1);
        for run in runs {
            whole += run;
        }
        for (row, &column) in shared.iter().enumerate() {
            let shared = self.shared[column];
            if shared.has_prior() {
                let value = estimate.get(shared) / estimate.scale(shared);
                whole[(row, row)] += 1.0;
                whole[(row, last)] -= value;
                whole[(last, row)] -= value;
                whole[(last, last)] += value * value;
            }
        }
        Gram::eliminating(whole, eliminated)
    }

    /// Normal matrix and right-hand side of the shared parameters, with the load errors eliminated.
    #[must_use]
    pub fn reduced(&self, estimate: &Estimate) -> (DMatrix<f64>, DVector<f64>) {
        let all: Vec<usize> = (0..self.shared.len()).collect();
        let Gram { matrix, pull, .. } = self.gram(estimate, (&all, 0), &[], &self.residuals());
        (matrix, pull)
    }

    /// Whitened residuals of each run.
    #[must_use]
    pub fn residuals(&self) -> Vec<&[f64]> {
        let runs = self.runs.iter();
        runs.map(|run| run.residual.as_slice()).collect()
    }

    /// Solution of the damped normal equations with the parameters selected by `held` fixed; `None` if they are
    /// singular.
    ///
    /// A parameter at an end of its range whose step points outwards is fixed there, and the others are solved without
    /// it. Clamping it after the solution would leave the others at a step that assumes it had moved.
    #[must_use]
    pub fn step(
        &self,
        estimate: &Estimate,
        damping: f64,
        held: impl Fn(Shared) -> bool,
    ) -> Option<Step> {
        let (mut matrix, mut right) = self.reduced(estimate);
        for k in 0..matrix.nrows() {
            matrix[(k, k)] = matrix[(k, k)] * (1.0 + damping) + 1e-9;
        }
        for k in (0..matrix.nrows()).filter(|&k| held(self.shared[k])) {
            hold(&mut matrix, &mut right, k);
        }
        let shared = loop {
            let step = matrix.clone().cholesky()?.solve(&right);
            let leaving = (0..step.len()).find(|&k| {
                let value = estimate.get(self.shared[k]);
                let (low, high) = estimate.range(self.shared[k]);
                (value <= low && step[k] < 0.0) || (value >= high && step[k] > 0.0)
            });
            let Some(leaving) = leaving else {
                break step;
            };
            hold(&mut matrix, &mut right, leaving);
        };
        let runs = self.runs.iter();
        let loads = runs
            .map(|run| run.load_step(&run.left(&shared, 0.0)))
            .collect();
        Some(Step { shared, loads })
    }
}

impl Jacobian {
    /// Sum of squared residuals predicted for a step, to first order.
    #[must_use]
    pub fn predicted_square_sum(&self, step: &Step) -> f64 {
        let runs = self.runs.iter().zip(&step.loads);
        runs.map(|(run, &load)| {
            let left = run.left(&step.shared, load);
            dot(&left, &left)
        })
        .sum()
    }

    /// Moves to the end of a step, with Broyden's rank-one update of the sensitivities (Broyden 1965).
    pub fn correct(&mut self, step: &Step, residuals: &[Vec<f64>], estimate: &Estimate) {
        for (index, run) in self.runs.iter_mut().enumerate() {
            let load = run.load.as_ref().map_or(0.0, |_| step.loads[index]);
            let square = step.shared.norm_squared() + load * load;
            if square > 0.0 {
                // Excess of the residuals over the linear prediction.
                let mut missed = residuals[index].clone();
                subtract(&mut missed, 1.0, &run.left(&step.shared, load));
                for (column, &own) in run.shared.iter_mut().zip(step.shared.iter()) {
                    subtract(column, own / square, &missed);
                }
                if let Some(column) = &mut run.load {
                    subtract(column, load / square, &missed);
                }
            }
            run.residual.clone_from(&residuals[index]);
            run.load_value = estimate.load(index);
        }
    }
}

/// Removes an unknown from the normal equations: its step is zero.
fn hold(matrix: &mut DMatrix<f64>, right: &mut DVector<f64>, unknown: usize) {
    matrix.row_mut(unknown).fill(0.0);
    matrix.column_mut(unknown).fill(0.0);
    matrix[(unknown, unknown)] = 1.0;
    right[unknown] = 0.0;
}

impl RunJacobian {
    /// The load's column, its squared norm plus the unit prior, and the gradient of `residual` along it, prior
    /// included.
    #[must_use]
    pub fn load_pull(&self, residual: &[f64]) -> Option<(&[f64], f64, f64)> {
        let load = self.load.as_deref()?;
        let pull = dot(load, residual) - self.load_value;
        Some((load, dot(load, load) + 1.0, pull))
    }

    /// Residuals after steps of the shared parameters and of the load error, to first order.
    fn left(&self, shared: &DVector<f64>, load: f64) -> Vec<f64> {
        let mut left = self.residual.clone();
        for (column, &step) in self.shared.iter().zip(shared.iter()) {
            subtract(&mut left, step, column);
        }
        if let Some(column) = &self.load {
            subtract(&mut left, load, column);
        }
        left
    }

    /// Step of the load error, in prior sigmas, that minimises `residual`.
    fn load_step(&self, residual: &[f64]) -> f64 {
        self.load_pull(residual)
            .map_or(0.0, |(_, square, pull)| pull / square)
    }

    /// Dot products of columns, the residuals last, with the load error eliminated.
    fn products(&self, columns: &[&[f64]]) -> DMatrix<f64> {
        let size = columns.len();
        let mut matrix = DMatrix::zeros(size, size);
        for row in 0..size {
            for column in 0..=row {
                let product = dot(columns[row], columns[column]);
                matrix[(row, column)] = product;
                matrix[(column, row)] = product;
            }
        }
        if let Some(load) = &self.load {
            let mut coupling = DVector::from_iterator(size, columns.iter().map(|c| dot(c, load)));
            coupling[size - 1] -= self.load_value;
            matrix[(size - 1, size - 1)] += self.load_value * self.load_value;
            let square = dot(load, load) + 1.0;
            matrix -= &coupling * coupling.transpose() / square;
        }
        matrix
    }
}
