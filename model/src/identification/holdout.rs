//! Error in runs that were not used to fit.

use rayon::prelude::*;

use super::estimate::Estimate;
use super::experiment::Experiment;
use super::fit::{ErrorSums, evaluate, fit_loads, refine_once};
use crate::model::Model;

/// Number of parts that the runs are dealt into, each held out once.
const FOLDS: usize = 4;

/// Held-out error of a model that was fitted to all runs, as [`super::fit::Fit::error`] counts it.
///
/// The runs are dealt round-robin, whole: samples of one run are never on both sides. Shared parameters come from the
/// other runs; a held-out run only chooses its own load error, within its prior. NaN with fewer than two runs.
#[must_use]
pub fn held_out_error(experiment: &Experiment, model: &Model, estimate: &Estimate) -> f64 {
    let folds = FOLDS.min(experiment.runs.len());
    if folds < 2 {
        return f64::NAN;
    }
    let sums: Vec<ErrorSums> = (0..folds)
        .into_par_iter()
        .map(|fold| {
            let outside = |run: usize| run % folds != fold;
            let (train, train_start) = part(experiment, estimate, outside);
            let trained = refine_once(&train, model, train_start);
            let (test, test_start) = part(experiment, estimate, |run| !outside(run));
            let start = Estimate {
                effects: trained.effects,
                clocks: trained.clocks,
                nuisances: test_start.nuisances,
            };
            let loaded = fit_loads(&test, model, start);
            ErrorSums::of(&evaluate(&test, model, loaded))
        })
        .collect();
    ErrorSums::total(&sums).error()
}

/// The runs that `chosen` picks, and the estimate for them.
fn part(
    experiment: &Experiment,
    estimate: &Estimate,
    chosen: impl Fn(usize) -> bool,
) -> (Experiment, Estimate) {
    let picked: Vec<usize> = (0..experiment.runs.len())
        .filter(|&run| chosen(run))
        .collect();
    let mut part = experiment.without_runs();
    part.runs = picked
        .iter()
        .map(|&run| experiment.runs[run].clone())
        .collect();
    let estimate = Estimate {
        nuisances: picked.iter().map(|&run| estimate.nuisances[run]).collect(),
        ..estimate.clone()
    };
    (part, estimate)
}
