//! Error in runs that were not used to fit.

use rayon::prelude::*;

use super::estimate::Estimate;
use super::experiment::Experiment;
use super::fit::{ErrorSums, Fit, evaluate_weighted, fit_loads, refine_once};
use super::residual::Weights;
use crate::model::Model;

/// Number of parts that the runs are dealt into, each held out once.
const FOLDS: usize = 4;

/// Held-out error of a model that was fitted to all runs, as [`super::fit::Fit::error`] counts it.
///
/// The runs are dealt round-robin, whole: samples of one run are never on both sides. Shared parameters come from the
/// other runs; a held-out run only chooses its own load error, within its prior. The yardsticks are those of the fit to
/// all runs. NaN with fewer than two runs.
#[must_use]
pub fn held_out_error(experiment: &Experiment, model: &Model, fit: &Fit) -> f64 {
    let folds = FOLDS.min(experiment.runs.len());
    if folds < 2 {
        return f64::NAN;
    }
    let sums: Vec<ErrorSums> = (0..folds)
        .into_par_iter()
        .map(|fold| {
            let outside = |run: usize| run % folds != fold;
            let (train, weights, start) = part(experiment, fit, outside);
            let trained = refine_once(&train, model, &weights, start);
            let (test, weights, test_start) = part(experiment, fit, |run| !outside(run));
            let start = Estimate {
                effects: trained.effects,
                clocks_held: false,
                clocks: trained.clocks,
                nuisances: test_start.nuisances,
            };
            let loaded = fit_loads(&test, model, &weights, start);
            ErrorSums::of(&evaluate_weighted(&test, model, loaded, weights))
        })
        .collect();
    ErrorSums::total(&sums).error()
}

/// The runs that `chosen` picks, with their weights and the estimate for them.
fn part(
    experiment: &Experiment,
    fit: &Fit,
    chosen: impl Fn(usize) -> bool,
) -> (Experiment, Weights, Estimate) {
    let picked: Vec<usize> = (0..experiment.runs.len())
        .filter(|&run| chosen(run))
        .collect();
    let mut part = experiment.without_runs();
    part.runs = picked
        .iter()
        .map(|&run| experiment.runs[run].clone())
        .collect();
    let estimate = Estimate {
        nuisances: picked
            .iter()
            .map(|&run| fit.estimate.nuisances[run])
            .collect(),
        ..fit.estimate.clone()
    };
    (part, fit.weights.of_runs(&picked), estimate)
}
