//! What an effect has to explain to be worth its parameters.

use hitch_plant::AddedEffect;

use crate::data::experiment::Experiment;
use crate::estimate::Estimate;
use crate::estimation::fit::Fit;
use crate::estimation::jacobian::square_sum;
use crate::selection::evidence::{VISIBLE, variance_inflation};

/// Number of effects, in their forms, that are tried: the best of so many has that much luck.
const TRIED: f64 = 50.0;

/// Logarithm of how much rarer than usual forms those are that say more: where another effect explains as much, it is
/// that one.
const RARER: f64 = 3.0;

/// Mean square up to which a model leaves no more than noise.
const NOISE: f64 = 1.0;

/// Smallest detectability that is believed where a model leaves no more than noise and no runs can be held out: nothing
/// refutes a faint signature there.
const VISIBLE_UNREFUTED: f64 = 0.3;

/// The penalty of effects beside a fit, in units of its cost.
///
/// Each parameter costs what Schwarz's criterion asks for at the effective number of samples, each effect the logarithm
/// of the number of effects tried, and what the smallest detectability that is believed would explain. All grow with
/// what the fit leaves: beside two sigmas that nothing explains, a tenth of a sigma says nothing.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Penalty {
    samples: f64,
    variance: f64,
    /// Smallest detectability that is believed, sigmas.
    visible: f64,
    /// What the cost falls by for a likelihood ratio of one.
    pub unit: f64,
}

impl Penalty {
    /// The penalty beside residuals whose mean square is `variance`.
    pub fn new(
        experiment: &Experiment,
        samples: usize,
        variance: f64,
        residuals: &[Vec<f64>],
    ) -> Self {
        let visible = match variance <= NOISE && experiment.runs.len() < 2 {
            true => VISIBLE_UNREFUTED,
            false => VISIBLE,
        };
        let variance = variance.max(1.0);
        Self {
            visible,
            samples: samples as f64,
            variance,
            unit: variance * variance_inflation(experiment, residuals, residuals),
        }
    }

    /// The penalty beside a fit.
    pub fn beside(experiment: &Experiment, fit: &Fit) -> Self {
        let samples = fit.weights.count();
        let variance = square_sum(&fit.residuals) / samples as f64;
        Self::new(experiment, samples, variance, &fit.residuals)
    }

    /// What an effect with so many free parameters has to explain.
    pub fn of(&self, added: &AddedEffect, parameters: usize) -> f64 {
        self.seen() + self.unit * self.log_odds(added, parameters)
    }

    /// What all effects of an estimate that were added or changed have to explain.
    pub fn of_all(&self, estimate: &Estimate) -> f64 {
        let effects = (0..estimate.effects.len()).filter(|&index| !estimate.is_unchanged(index));
        let prices = effects.map(|index| {
            let added = &estimate.effects[index];
            let free = estimate.free_parameters(added.effect.id());
            self.of(added, free.min(added.values.len()))
        });
        prices.sum()
    }

    /// What an effect has to explain at least, whatever it says.
    pub fn of_nothing(&self) -> f64 {
        self.seen()
    }

    /// What the smallest detectability that is believed explains.
    fn seen(&self) -> f64 {
        self.visible * self.visible * self.samples * self.variance
    }

    /// Twice the logarithm of the odds against an effect before anything is seen.
    fn log_odds(&self, added: &AddedEffect, parameters: usize) -> f64 {
        let effective = (self.samples * self.variance / self.unit).max(2.0);
        let rare = if added.effect.refines() { RARER } else { 0.0 };
        parameters as f64 * effective.ln() + 2.0 * (TRIED.ln() + rare)
    }
}
