//! Sensitivities of the residuals to free constants, and their normal equations.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};

use crate::data::experiment::Experiment;
use crate::data::problem::Problem;
use crate::data::ready_run::ReadyRun;
use crate::estimate::{Estimate, Shared};
use crate::estimation::fit::Fit;
use crate::estimation::jacobian::Jacobian;
use crate::estimation::nuisance_projection::NuisanceProjection;
use crate::estimation::residual_columns::{dot, huber};
use crate::parallel;
use crate::selection::candidate::{jacobian_by, slow_columns};

/// Length of a stretch, s: the errors of a move and of the rest after it are one error, those of two moves are two.
const STRETCH_S: f64 = 2.0;

/// Sensitivities at a fit with free constants.
pub(crate) struct Sensitivities {
    /// The estimate of the fit.
    pub estimate: Estimate,
    /// Its residuals, transformed by [`huber`].
    pub residuals: Vec<Vec<f64>>,
    /// Their sensitivities.
    pub jacobian: Jacobian,
}

impl Sensitivities {
    /// At a fit with free constants.
    pub fn at(problem: Problem<'_>, fit: &Fit) -> Self {
        Self {
            estimate: fit.estimate.clone(),
            residuals: huber(fit.residuals.clone()),
            jacobian: jacobian_by(problem, fit, &slow_columns(problem, fit)),
        }
    }

    /// Whether a column of the Jacobian belongs to a constant.
    pub fn is_constant(&self, column: usize) -> bool {
        matches!(self.jacobian.shared[column], Shared::Constants(_))
    }

    /// Scatter of the slopes of the cost over the constants between the stretches of the campaign, all other parameters
    /// eliminated: sum of the outer products, corrected for the number of constants that the slopes add up to zero for.
    pub fn scatter_of_slopes(&self, experiment: &Experiment) -> DMatrix<f64> {
        let columns = 0..self.jacobian.shared.len();
        let own: Vec<usize> = columns.filter(|&column| self.is_constant(column)).collect();
        let others =
            NuisanceProjection::keeping(&self.jacobian, &self.estimate, |k| !self.is_constant(k));
        let signatures: Vec<Vec<Vec<f64>>> = parallel::map(&own, |&column| {
            let runs = self.jacobian.runs.iter();
            others.project(runs.map(|run| run.shared[column].clone()).collect())
        });
        let mut scatter = DMatrix::zeros(own.len(), own.len());
        let mut stretches = 0;
        for (index, run) in experiment.runs.iter().enumerate() {
            let (residual, samples) = (&self.residuals[index], run.len());
            for stretch in stretches_of(run) {
                let slope = |signature: &Vec<Vec<f64>>| -> f64 {
                    let signature = &signature[index];
                    let of_channel = |channel: usize| {
                        let at = channel * samples + stretch.start..channel * samples + stretch.end;
                        dot(&signature[at.clone()], &residual[at])
                    };
                    (0..4).map(of_channel).sum()
                };
                let slopes = DVector::from_iterator(own.len(), signatures.iter().map(slope));
                scatter += &slopes * slopes.transpose();
                stretches += 1;
            }
        }
        let left = (stretches as f64 - own.len() as f64).max(1.0);
        scatter * (f64::from(stretches) / left)
    }

    /// Precision of the constants with all other parameters eliminated, in units of the prior's, and half of the negative
    /// gradient of the cost along them. Parameters at an end of their range stay there.
    pub fn normal_equations(&self) -> (DMatrix<f64>, DVector<f64>) {
        let columns = 0..self.jacobian.shared.len();
        let (own, others): (Vec<usize>, Vec<usize>) =
            columns.partition(|&column| self.is_constant(column));
        let can_move = |&column: &usize| {
            let shared = self.jacobian.shared[column];
            !self.estimate.is_at_an_end(shared)
        };
        let others: Vec<usize> = others.into_iter().filter(can_move).collect();
        let shared = [others.as_slice(), &own].concat();
        let (eliminated, residuals) =
            ((shared.as_slice(), others.len()), self.jacobian.residuals());
        let gram = self
            .jacobian
            .gram(&self.estimate, eliminated, &[], &residuals);
        (gram.matrix, gram.pull)
    }
}

/// The stretches of a run: [`STRETCH_S`] each.
fn stretches_of(run: &ReadyRun) -> Vec<Range<usize>> {
    let time_s = &run.drive.time_s;
    let mut stretches = Vec::new();
    let mut start = 0;
    for sample in 1..=time_s.len() {
        if sample == time_s.len() || time_s[sample] - time_s[start] >= STRETCH_S {
            stretches.push(start..sample);
            start = sample;
        }
    }
    stretches
}
