//! Complexity penalty: the cost reduction that an effect needs to justify its parameters.

use hitch_plant::AddedEffect;

use crate::data::experiment::Experiment;
use crate::estimate::Estimate;
use crate::estimation::fit::Fit;
use crate::estimation::residual_columns::square_sum;
use crate::selection::evidence::{VISIBLE, variance_inflation};

/// Number of effects, in their forms, that are tried: correction for multiple testing.
const TRIED: f64 = 50.0;

/// Log prior odds against a form that is more specific than the usual one of its effect: an alternative that explains
/// as much is then preferred.
const RARER: f64 = 3.0;

/// Mean square up to which the residuals are compatible with noise.
const NOISE: f64 = 1.0;

/// Smallest accepted detectability, in sigma, if the model alone is compatible with noise and the campaign has a single
/// run: no held-out run can then refute a faint signature.
const VISIBLE_UNREFUTED: f64 = 0.3;

/// The penalty of effects given the residuals of a fit, in units of its cost.
///
/// Each parameter costs Schwarz's penalty at the effective number of samples. Each effect costs the logarithm of the
/// number of effects tried, and the cost reduction at the smallest accepted detectability. All terms scale with the
/// residuals of the fit: with two sigmas unexplained, a signature of a tenth of a sigma is not significant.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Penalty {
    samples: f64,
    variance: f64,
    /// Smallest accepted detectability, in sigma.
    visible: f64,
    /// Cost per unit of the likelihood ratio.
    pub unit: f64,
}

impl Penalty {
    /// The penalty given residuals whose mean square is `variance`.
    pub fn new(
        experiment: &Experiment,
        samples: usize,
        variance: f64,
        residuals: &[Vec<f64>],
    ) -> Self {
        let visible = if variance <= NOISE && experiment.runs.len() < 2 {
            VISIBLE_UNREFUTED
        } else {
            VISIBLE
        };
        let variance = variance.max(1.0);
        Self {
            visible,
            samples: samples as f64,
            variance,
            unit: variance * variance_inflation(experiment, residuals, residuals),
        }
    }

    /// The penalty given the residuals of a fit.
    pub fn given(experiment: &Experiment, fit: &Fit) -> Self {
        let samples = fit.weights.count();
        let variance = square_sum(&fit.residuals) / samples as f64;
        Self::new(experiment, samples, variance, &fit.residuals)
    }

    /// Cost reduction that an effect with this many free parameters needs.
    pub fn of(&self, added: &AddedEffect, parameters: usize) -> f64 {
        self.visibility_cost() + self.unit * self.log_odds(added, parameters)
    }

    /// Cost reduction that all added or changed effects of an estimate need.
    pub fn of_all(&self, estimate: &Estimate) -> f64 {
        let prices = estimate.changed().map(|index| {
            let added = &estimate.effects[index];
            let free = estimate.free_parameters(added.effect.id());
            self.of(added, free.min(added.values.len()))
        });
        prices.sum()
    }

    /// Cost reduction that constants off by more than the accuracy of any model need, given the logarithm of the factor by
    /// which the campaign narrows their prior. An effect that explains as much is preferred.
    pub fn of_constants(&self, narrowed: f64) -> f64 {
        self.visibility_cost() + self.unit * (narrowed + 2.0 * (TRIED.ln() + RARER))
    }

    /// Cost reduction that any effect needs, regardless of its parameters.
    pub fn minimum(&self) -> f64 {
        self.visibility_cost()
    }

    /// Cost reduction at the smallest accepted detectability.
    fn visibility_cost(&self) -> f64 {
        self.visible * self.visible * self.samples * self.variance
    }

    /// Twice the log prior odds against an effect.
    fn log_odds(&self, added: &AddedEffect, parameters: usize) -> f64 {
        let effective = (self.samples * self.variance / self.unit).max(2.0);
        let rare = if added.effect.refines() { RARER } else { 0.0 };
        parameters as f64 * effective.ln() + 2.0 * (TRIED.ln() + rare)
    }
}
