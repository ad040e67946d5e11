//! Sensitivities to the nuisance parameters: clocks, loads and free constants. They hardly change between iterations.

use hitch_plant::Channel;
use hitch_plant::simulation::Trace;

use crate::constants::free::FreeConstants;
use crate::data::clocks::{Clocks, OFFSET_PRIOR_S};
use crate::data::experiment::Experiment;
use crate::data::nuisance::CurrentShift;
use crate::data::problem::Problem;
use crate::estimate::{Estimate, Shared};
use crate::estimation::residual_columns::{
    central_quotients, dot, huber, huber_residuals, quotient, quotients,
};
use crate::parallel;
use crate::residuals::whitening::Weights;

/// Step of a channel's clock offset, in prior sigmas.
const STEP_OF_OFFSET: f64 = 0.25;

/// Step of constants to either side, in tolerances.
const STEP_OF_CONSTANTS: f64 = 0.02;

/// Sensitivities of all runs to their load errors, per step of one prior sigma.
fn load_columns(
    problem: Problem<'_>,
    weights: &Weights,
    estimate: &Estimate,
    base: &[Vec<f64>],
) -> Vec<Vec<f64>> {
    let mut moved = estimate.clone();
    let steps: Vec<f64> = (0..problem.experiment.runs.len())
        .map(|run| {
            let load = estimate.load(run);
            moved.set_load(run, load + 1.0);
            if moved.load(run) - load < 0.5 {
                // The load error is at the end of its range.
                moved.set_load(run, load - 1.0);
            }
            moved.load(run) - load
        })
        .collect();
    let moved = huber_residuals(problem, weights, &moved);
    let runs = base.iter().zip(moved).zip(steps);
    runs.map(|((base, moved), step)| quotient(base, moved, step))
        .collect()
}

/// Sensitivities of all runs to the channels' clock offsets, per step of one prior sigma; by channel, then by run.
fn offset_columns(
    problem: Problem<'_>,
    weights: &Weights,
    estimate: &Estimate,
) -> [Vec<Vec<f64>>; 4] {
    let Problem { experiment, .. } = problem;
    let model = estimate.applied_to(problem.model);
    let columns: Vec<[Vec<f64>; 4]> = parallel::map(0..experiment.runs.len(), |index| {
        let nuisance = estimate.nuisances[index];
        let plain = experiment.runs[index].trace(&model, nuisance, CurrentShift::default());
        offset_columns_of_run(experiment, index, weights, &plain, estimate.clocks)
    });
    std::array::from_fn(|channel| columns.iter().map(|run| run[channel].clone()).collect())
}

/// Sensitivities of one run to the channels' clock offsets, per step of one prior sigma, by channel.
///
/// An offset only shifts a channel of the trace: one simulation serves all four.
fn offset_columns_of_run(
    experiment: &Experiment,
    index: usize,
    weights: &Weights,
    plain: &Trace,
    clocks: Clocks,
) -> [Vec<f64>; 4] {
    let (run, weights) = (&experiment.runs[index], &weights.runs[index]);
    let stamped = run.stamped(plain, &clocks);
    let residual = |trace: &Trace| huber(vec![weights.whiten(run, trace)]).swap_remove(0);
    let base = residual(&stamped);
    std::array::from_fn(|channel| {
        if channel == Channel::PumpPressure.index() && !experiment.ringing {
            // A clock would move only its jumps, and samples next to those are left out.
            return vec![0.0; base.len()];
        }
        let mut moved = clocks;
        moved.offsets_s[channel] += STEP_OF_OFFSET * OFFSET_PRIOR_S;
        let mut trace = stamped.clone();
        let late = moved.stamped_channel(Channel::ALL[channel], &run.drive.time_s, plain);
        trace.channels[channel] = late;
        quotient(&base, residual(&trace), STEP_OF_OFFSET)
    })
}

/// Sensitivities of all runs to the free constants, per step of one prior sigma; by direction, then by run. The
/// quotients are central: the curvature error of a one-sided quotient would appear to determine a direction that the
/// campaign does not show. Smooth directions are fewer than the unknowns, so that they are moved themselves.
fn constant_columns(
    problem: Problem<'_>,
    weights: &Weights,
    estimate: &Estimate,
) -> Vec<Vec<Vec<f64>>> {
    let free = estimate.constants.as_ref();
    let Some(free) = free.filter(|free| free.free() > 0) else {
        return Vec::new();
    };
    if free.is_smooth() {
        let column = |direction: usize| {
            let (shared, step) = (Shared::Constants(direction), STEP_OF_CONSTANTS);
            central_quotients(problem, weights, estimate, shared, step)
        };
        return parallel::map(0..free.free(), column);
    }
    let residuals = |constants: &FreeConstants| {
        let constants = Some(constants.clone());
        huber_residuals(
            problem,
            weights,
            &estimate.clone().with_constants(constants),
        )
    };
    free.sensitivities(STEP_OF_CONSTANTS, |[down, up], step| {
        let (below, above) = rayon::join(|| residuals(down), || residuals(up));
        quotients(&below, above, step)
    })
}

/// Columns that hardly change between iterations: those of the clocks, the loads and the free constants.
#[derive(Debug, Clone)]
pub struct SlowColumns {
    /// In the order of [`crate::estimate::CLOCKS`], by run.
    pub(super) clocks: [Vec<Vec<f64>>; 4],
    /// By direction of the free constants and by run.
    pub(super) constants: Vec<Vec<Vec<f64>>>,
    /// By run.
    pub(super) loads: Vec<Vec<f64>>,
}

impl SlowColumns {
    /// Difference quotients at `estimate`, whose residuals are `base`.
    #[must_use]
    pub fn new(
        problem: Problem<'_>,
        weights: &Weights,
        estimate: &Estimate,
        base: &[Vec<f64>],
    ) -> Self {
        let (clocks, (loads, constants)) = rayon::join(
            || offset_columns(problem, weights, estimate),
            || {
                rayon::join(
                    || load_columns(problem, weights, estimate, base),
                    || constant_columns(problem, weights, estimate),
                )
            },
        );
        Self {
            clocks,
            constants,
            loads,
        }
    }
}

/// Optimal steps of the load errors, in prior sigmas, with all other parameters fixed.
#[must_use]
pub fn load_steps(problem: Problem<'_>, weights: &Weights, estimate: &Estimate) -> Vec<f64> {
    let Problem { experiment, .. } = problem;
    let base = huber_residuals(problem, weights, estimate);
    let loads = load_columns(problem, weights, estimate, &base);
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
