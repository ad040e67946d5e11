//! Cross-validation: error in held-out runs, or in held-out blocks of the only run.

use crate::data::experiment::Experiment;
use crate::data::problem::Problem;
use crate::estimate::Estimate;
use crate::estimation::fit::{ErrorSums, Fit, evaluate_weighted, fit_loads, refine_once};
use crate::parallel;
use crate::residuals::whitening::Weights;

/// Number of folds.
const FOLDS: usize = 4;

/// Blocks of time per fold of a campaign of one run: each fold then has parts from both halves of the run.
const BLOCKS: usize = 2;

/// Error of a model in held-out runs, in sigma.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeldOut {
    /// Error as defined by [`crate::estimation::fit::Fit::error`].
    pub error: f64,
    /// The same after Huber's loss; models are compared by this. While a second effect is missing, a run may be
    /// simulated against a stop that the hitch never reached, and its dead-head pressure would dominate the error.
    pub loss: f64,
}

impl HeldOut {
    /// Nothing was held out.
    pub const NONE: Self = Self {
        error: f64::NAN,
        loss: f64::NAN,
    };

    /// Squared loss above that of noise.
    #[must_use]
    pub fn excess(self) -> f64 {
        self.loss * self.loss - 1.0
    }
}

/// Error of a model in held-out data after a fit to all of it.
///
/// Whole runs are assigned to the folds in turn, so samples of one run are never on both sides. Shared parameters come
/// from the other runs; for a held-out run only its load error is fitted, within its prior. The weights are those of
/// the fit to all runs. Free constants keep their values: some twenty parameters with a prior cannot follow the noise of
/// a fold.
///
/// The only run of a campaign is divided into blocks of time instead. The simulation passes through all of them, and the
/// angle's filter predicts a sample from the measured ones before it also where they are held out; all parameters and the
/// load come from the other blocks.
#[must_use]
pub fn held_out(problem: Problem<'_>, fit: &Fit) -> HeldOut {
    let runs = problem.experiment.runs.len();
    let folds = if runs == 1 { FOLDS } else { FOLDS.min(runs) };
    let parts = parallel::map(0..folds, |fold| {
        let tested = match runs {
            1 => held_out_blocks(problem, fit, fold),
            _ => held_out_runs(problem, fit, fold, folds),
        };
        (ErrorSums::of(&tested), ErrorSums::with_huber_loss(&tested))
    });
    let (errors, losses): (Vec<_>, Vec<_>) = parts.into_iter().unzip();
    HeldOut {
        error: ErrorSums::total(&errors).error(),
        loss: ErrorSums::total(&losses).error(),
    }
}

/// The fit to the runs outside a fold, evaluated on those of the fold.
fn held_out_runs(problem: Problem<'_>, fit: &Fit, fold: usize, folds: usize) -> Fit {
    let experiment = problem.experiment;
    let outside = |run: usize| run % folds != fold;
    let (train, weights, start) = part(experiment, fit, outside);
    let start = start.with_constants_held(true);
    let trained = refine_once(problem.on(&train), &weights, start);
    let (test, weights, test_start) = part(experiment, fit, |run| !outside(run));
    let start = Estimate {
        effects: trained.effects,
        adopted: trained.adopted,
        fixed: trained.fixed,
        clocks: trained.clocks,
        nuisances: test_start.nuisances,
        clocks_within_s: test_start.clocks_within_s,
        constants: trained.constants,
    };
    let test = problem.on(&test);
    let loaded = fit_loads(test, &weights, start);
    evaluate_weighted(test, loaded, weights)
}

/// The fit to the blocks of the only run outside a fold, evaluated on those of the fold.
fn held_out_blocks(problem: Problem<'_>, fit: &Fit, fold: usize) -> Fit {
    let samples = problem.experiment.runs[0].len();
    let inside = |sample: usize| sample * FOLDS * BLOCKS / samples % FOLDS == fold;
    let train = fit.weights.of_samples(|sample| !inside(sample));
    let start = fit.estimate.clone().with_constants_held(true);
    let trained = refine_once(problem, &train, start);
    evaluate_weighted(problem, trained, fit.weights.of_samples(inside))
}

/// The runs selected by `chosen`, with their weights and their estimate.
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
