//! A fit on a condensed experiment, for screening before full fits.

use crate::data::experiment::Experiment;
use crate::data::problem::Problem;
use crate::estimation::fit::{Fit, evaluate, evaluate_weighted};

/// A fit and its experiment, both condensed if that saves most of the work.
pub(crate) struct Coarse<'a> {
    /// The measured data and the model.
    pub problem: Problem<'a>,
    /// The fit to all samples.
    pub present: &'a Fit,
    /// The experiment on fewer samples.
    pub few: Experiment,
    /// The estimate of `present`, evaluated on `few`.
    pub seen: Fit,
    /// The runs of `few` with coarse time steps, corrected around the present fit.
    pub coarse_in_time: Experiment,
}

impl<'a> Coarse<'a> {
    /// Condenses the experiment of a fit.
    pub fn new(problem: Problem<'a>, present: &'a Fit) -> Self {
        let Problem {
            experiment, model, ..
        } = problem;
        let fitted = present.estimate.applied_to(model);
        let nuisances = &present.estimate.nuisances;
        let few = experiment.condensed(&fitted, nuisances);
        let seen = if few.samples() < experiment.samples() {
            evaluate(problem.on(&few), present.estimate.clone())
        } else {
            present.clone()
        };
        let coarse_in_time = few.coarse_in_time(&fitted, nuisances);
        Self {
            problem,
            present,
            few,
            seen,
            coarse_in_time,
        }
    }

    /// The condensed experiment, and the model.
    pub fn condensed(&self) -> Problem<'_> {
        self.problem.on(&self.few)
    }

    /// The condensed experiment with coarse time steps, and the model.
    pub fn with_coarse_steps(&self) -> Problem<'_> {
        self.problem.on(&self.coarse_in_time)
    }

    /// Cost of another fit on the condensed experiment, under the weights of this one or its own, whichever is less.
    pub fn cost(&self, fit: &Fit) -> f64 {
        let estimate = || fit.estimate.clone();
        if fit.cost == self.present.cost {
            return self.seen.cost;
        }
        let weights = self.seen.weights.clone();
        let under_these = evaluate_weighted(self.condensed(), estimate(), weights).cost;
        under_these.min(evaluate(self.condensed(), estimate()).cost)
    }
}
