//! Sensitivities of the whitened residuals, and the normal equations with each run's own nuisance eliminated.
//!
//! Every run has a load error of its own, so the normal equations have an arrow's shape: shared parameters couple all
//! runs, a run's nuisance only itself. Eliminating the latter run by run (Schur complement) leaves a system as small
//! as the number of shared parameters, and columns from which a nuisance can no longer take anything: the projected
//! signatures.

use hitch_plant::{Channel, Model, SizeResponse};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::data::clocks::OFFSET_PRIOR_S;
use crate::data::experiment::Experiment;
use crate::data::trace_cache::CurrentShift;
use crate::estimate::{Estimate, Shared, Step};
use crate::residuals::whitening::Weights;

/// Step of a difference quotient, as a share of the parameter, or of its scale if that is more.
const STEP: f64 = 0.02;

/// The same where a small change soon makes all different. What rings a hundredth slower is a third of a radian behind
/// after five swings, and a secant is no slope any more; a hitch that stands on the ground hangs above one that is
/// millimetres lower.
const FINE_STEP: f64 = 0.002;

/// The same for a channel's offset, in prior sigmas.
const STEP_OF_OFFSET: f64 = 0.25;

/// One run's residuals and their sensitivities to steps of one scale.
#[derive(Debug, Clone)]
pub struct RunJacobian {
    /// Whitened residuals.
    pub residual: Vec<f64>,
    /// A column for each shared parameter: change of the simulation, whitened.
    pub shared: Vec<Vec<f64>>,
    /// Column of the load error; `None` on a flow bench, and where it stands at an end of its range and would leave it:
    /// what cannot move on absorbs nothing.
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

/// Size from which a whitened residual counts no longer by its square but by its distance.
const OUTLYING: f64 = 10.0;

/// Whitened residuals of every run under an estimate.
#[must_use]
pub fn residuals(
    experiment: &Experiment,
    model: &Model,
    weights: &Weights,
    estimate: &Estimate,
) -> Vec<Vec<f64>> {
    let model = estimate.applied_to(model);
    (0..experiment.runs.len())
        .into_par_iter()
        .map(|index| {
            let run = &experiment.runs[index];
            let trace = run.simulate(&model, estimate.nuisances[index], &estimate.clocks);
            weights.runs[index].whiten(run, &trace)
        })
        .collect()
}

/// Residuals as a fit sees them: their squares are Huber's losses.
///
/// While an effect is missing a simulation may run against a stop that the hitch never reached, and a thousand sigmas
/// of dead-head pressure would drown all else. Below `OUTLYING` nothing changes.
#[must_use]
pub fn huber(mut residuals: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    for residual in residuals.iter_mut().flatten() {
        let size = residual.abs();
        if size > OUTLYING {
            *residual = (2.0 * OUTLYING * size - OUTLYING * OUTLYING)
                .sqrt()
                .copysign(*residual);
        }
    }
    residuals
}

/// [`residuals`] as a fit sees them.
#[must_use]
pub fn huber_residuals(
    experiment: &Experiment,
    model: &Model,
    weights: &Weights,
    estimate: &Estimate,
) -> Vec<Vec<f64>> {
    huber(residuals(experiment, model, weights, estimate))
}

/// Sum of squares of residuals.
#[must_use]
pub fn square_sum(residuals: &[Vec<f64>]) -> f64 {
    residuals.iter().map(|run| dot(run, run)).sum()
}

/// Dot product. Eight sums side by side: one alone could not be vectorised, as the order of a sum of floats counts.
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

/// What residuals `a` have more than `b`, run by run.
#[must_use]
pub fn difference(a: &[Vec<f64>], b: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let runs = a.iter().zip(b);
    runs.map(|(a, b)| a.iter().zip(b).map(|(a, b)| a - b).collect())
        .collect()
}

/// Takes `share` times `part` from `column`.
pub fn subtract(column: &mut [f64], share: f64, part: &[f64]) {
    for (value, part) in column.iter_mut().zip(part) {
        *value -= share * part;
    }
}

/// Change of the simulation a step of one scale: the residual falls where the simulation rises.
fn quotient(base: &[Vec<f64>], moved: Vec<Vec<f64>>, step: f64) -> Vec<Vec<f64>> {
    moved
        .into_iter()
        .zip(base)
        .map(|(mut moved, base)| {
            for (m, b) in moved.iter_mut().zip(base) {
                *m = (b - *m) / step;
            }
            moved
        })
        .collect()
}

/// Sensitivity of all runs to one shared parameter.
fn shared_column(
    experiment: &Experiment,
    model: &Model,
    weights: &Weights,
    estimate: &Estimate,
    base: &[Vec<f64>],
    parameter: Shared,
) -> Vec<Vec<f64>> {
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
    quotient(
        base,
        huber_residuals(experiment, model, weights, &moved),
        taken,
    )
}

/// Sensitivity of all runs to their load errors, a step of one prior sigma.
fn load_columns(
    experiment: &Experiment,
    model: &Model,
    weights: &Weights,
    estimate: &Estimate,
    base: &[Vec<f64>],
) -> Vec<Vec<f64>> {
    let mut moved = estimate.clone();
    let steps: Vec<f64> = (0..experiment.runs.len())
        .map(|run| {
            let load = estimate.load(run);
            moved.set_load(run, load + 1.0);
            if moved.load(run) - load < 0.5 {
                // It stands at the end of its range.
                moved.set_load(run, load - 1.0);
            }
            moved.load(run) - load
        })
        .collect();
    let moved = huber_residuals(experiment, model, weights, &moved);
    let mut columns = quotient(base, moved, 1.0);
    for (column, step) in columns.iter_mut().zip(steps) {
        column.iter_mut().for_each(|change| *change /= step);
    }
    columns
}

/// Sensitivities of all runs to the channels' offsets, a step of one prior sigma; by channel, then by run.
///
/// An offset only moves a channel of a trace that is there already: one simulation serves all four.
fn offset_columns(
    experiment: &Experiment,
    model: &Model,
    weights: &Weights,
    estimate: &Estimate,
) -> [Vec<Vec<f64>>; 4] {
    let model = estimate.applied_to(model);
    let columns: Vec<[Vec<f64>; 4]> = (0..experiment.runs.len())
        .into_par_iter()
        .map(|index| {
            let run = &experiment.runs[index];
            let (time_s, clocks) = (&run.drive.time_s, estimate.clocks);
            let plain = run.trace(&model, estimate.nuisances[index], CurrentShift::default());
            let stamped = run.stamped(&plain, &clocks);
            let base = huber(vec![weights.runs[index].whiten(run, &stamped)]);
            std::array::from_fn(|channel| {
                if channel == Channel::PumpPressure.index() && !experiment.ringing {
                    // All that a clock could move are its jumps, and those are left out.
                    return vec![0.0; base[0].len()];
                }
                let mut moved = clocks;
                moved.offsets_s[channel] += STEP_OF_OFFSET * OFFSET_PRIOR_S;
                let mut trace = stamped.clone();
                let late = moved.stamped_channel(Channel::ALL[channel], time_s, &plain);
                trace.channels[channel] = late;
                let moved = huber(vec![weights.runs[index].whiten(run, &trace)]);
                quotient(&base, moved, STEP_OF_OFFSET).swap_remove(0)
            })
        })
        .collect();
    std::array::from_fn(|channel| columns.iter().map(|run| run[channel].clone()).collect())
}

/// Columns that hardly change from one iteration to the next: of the clocks and of the loads.
#[derive(Debug, Clone)]
pub struct SlowColumns {
    /// In the order of [`crate::estimate::CLOCKS`], by run.
    clocks: [Vec<Vec<f64>>; 4],
    loads: Vec<Vec<f64>>,
}

impl SlowColumns {
    /// Difference quotients at `estimate`, which leaves the residuals `base`.
    #[must_use]
    pub fn new(
        experiment: &Experiment,
        model: &Model,
        weights: &Weights,
        estimate: &Estimate,
        base: &[Vec<f64>],
    ) -> Self {
        let (clocks, loads) = rayon::join(
            || offset_columns(experiment, model, weights, estimate),
            || load_columns(experiment, model, weights, estimate, base),
        );
        Self { clocks, loads }
    }
}

/// Steps of the load errors alone, in prior sigmas, that fit best with all else held.
#[must_use]
pub fn load_steps(
    experiment: &Experiment,
    model: &Model,
    weights: &Weights,
    estimate: &Estimate,
) -> Vec<f64> {
    let base = huber_residuals(experiment, model, weights, estimate);
    let loads = load_columns(experiment, model, weights, estimate, &base);
    base.iter()
        .zip(&loads)
        .enumerate()
        .map(|(run, (residual, load))| {
            if experiment.runs[run].on_hitch() {
                (dot(load, residual) - estimate.load(run)) / (dot(load, load) + 1.0)
            } else {
                0.0
            }
        })
        .collect()
}

impl Jacobian {
    /// Difference quotients at `estimate`, for all shared parameters and each run's load.
    #[must_use]
    pub fn new(
        experiment: &Experiment,
        model: &Model,
        weights: &Weights,
        estimate: &Estimate,
    ) -> Self {
        let base = huber_residuals(experiment, model, weights, estimate);
        let slow = SlowColumns::new(experiment, model, weights, estimate, &base);
        Self::with_slow_columns(experiment, model, weights, estimate, &base, &slow)
    }

    /// The same with the residuals known, and the columns of clocks and loads taken from a point nearby.
    #[must_use]
    pub fn with_slow_columns(
        experiment: &Experiment,
        model: &Model,
        weights: &Weights,
        estimate: &Estimate,
        base: &[Vec<f64>],
        slow: &SlowColumns,
    ) -> Self {
        let shared = estimate.shared();
        let columns: Vec<Vec<Vec<f64>>> = shared
            .par_iter()
            .filter(|parameter| !parameter.has_prior())
            .map(|&parameter| shared_column(experiment, model, weights, estimate, base, parameter))
            .collect();
        let runs = (0..base.len())
            .map(|run| RunJacobian {
                residual: base[run].clone(),
                shared: columns
                    .iter()
                    .map(|column| column[run].clone())
                    .chain(slow.clocks.iter().map(|clock| clock[run].clone()))
                    .collect(),
                load: (experiment.runs[run].on_hitch()
                    && !estimate.load_would_leave(run, dot(&slow.loads[run], &base[run])))
                .then(|| slow.loads[run].clone()),
                load_value: estimate.load(run),
            })
            .collect();
        Self { runs, shared }
    }

    /// Normal matrix and right-hand side of the shared parameters with the runs' loads eliminated.
    #[must_use]
    pub fn reduced(&self, estimate: &Estimate) -> (DMatrix<f64>, DVector<f64>) {
        let size = self.shared.len();
        let mut matrix = DMatrix::zeros(size, size);
        let mut right = DVector::zeros(size);
        for run in &self.runs {
            let (m, r) = run.reduced(size);
            matrix += m;
            right += r;
        }
        for (column, &shared) in self.shared.iter().enumerate() {
            if shared.has_prior() {
                matrix[(column, column)] += 1.0;
                right[column] -= estimate.get(shared) / estimate.scale(shared);
            }
        }
        (matrix, right)
    }

    /// The step that the damped normal equations give with what is `held` where it is; `None` if they are singular.
    ///
    /// A parameter that stands at an end of its range and would leave it is held there, and the others step without it:
    /// stopped only afterwards it would drag them along to where it cannot follow.
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
    /// Sum of squares of the residuals that a step leaves, to first order.
    #[must_use]
    pub fn promised(&self, step: &Step) -> f64 {
        let runs = self.runs.iter().zip(&step.loads);
        runs.map(|(run, &load)| {
            let left = run.left(&step.shared, load);
            dot(&left, &left)
        })
        .sum()
    }

    /// Goes on to where a step led, with the sensitivities corrected so that they would have led there (Broyden 1965).
    pub fn correct(&mut self, step: &Step, residuals: &[Vec<f64>], estimate: &Estimate) {
        for (index, run) in self.runs.iter_mut().enumerate() {
            let load = run.load.as_ref().map_or(0.0, |_| step.loads[index]);
            let square = step.shared.norm_squared() + load * load;
            if square > 0.0 {
                // What the step left is more than was promised by so much.
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

/// Takes an unknown out of normal equations: its step is nothing.
fn hold(matrix: &mut DMatrix<f64>, right: &mut DVector<f64>, unknown: usize) {
    matrix.row_mut(unknown).fill(0.0);
    matrix.column_mut(unknown).fill(0.0);
    matrix[(unknown, unknown)] = 1.0;
    right[unknown] = 0.0;
}

impl RunJacobian {
    /// The load's column, its squared length with the unit prior, and its pull on `residual`, prior included.
    #[must_use]
    pub fn load_pull(&self, residual: &[f64]) -> Option<(&[f64], f64, f64)> {
        let load = self.load.as_deref()?;
        let pull = dot(load, residual) - self.load_value;
        Some((load, dot(load, load) + 1.0, pull))
    }

    /// Residuals that steps of the shared parameters and of the load error leave, to first order.
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

    /// Step of the load error, in prior sigmas, that fits `residual` best.
    fn load_step(&self, residual: &[f64]) -> f64 {
        self.load_pull(residual)
            .map_or(0.0, |(_, square, pull)| pull / square)
    }

    fn reduced(&self, size: usize) -> (DMatrix<f64>, DVector<f64>) {
        let mut matrix = DMatrix::zeros(size, size);
        for i in 0..size {
            for j in 0..=i {
                let value = dot(&self.shared[i], &self.shared[j]);
                matrix[(i, j)] = value;
                matrix[(j, i)] = value;
            }
        }
        let pulls = self.shared.iter().map(|c| dot(c, &self.residual));
        let mut right = DVector::from_iterator(size, pulls);
        if let Some((load, square, pull)) = self.load_pull(&self.residual) {
            let coupling = DVector::from_iterator(size, self.shared.iter().map(|c| dot(c, load)));
            matrix -= &coupling * coupling.transpose() / square;
            right -= &coupling * (pull / square);
        }
        (matrix, right)
    }
}
