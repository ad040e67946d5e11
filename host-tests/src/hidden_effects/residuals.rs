//! Residuals for the established methods: measured minus simulated in sigma, with loads as weighed and clocks as
//! logged.
//!
//! The sigmas are those of the project: sensor noise, and the uncertainty from the logged currents. Without the latter,
//! samples at switched currents would dominate every method.

use hitch_effects::CATALOGUE;
use hitch_identification::data::clocks::Clocks;
use hitch_identification::data::experiment::Experiment;
use hitch_identification::data::nuisance::Nuisance;
use hitch_identification::data::problem::Problem;
use hitch_identification::estimate::Estimate;
use hitch_identification::residuals::whitening::Weights;
use hitch_plant::simulation::Trace;
use hitch_plant::{AddedEffect, Channel, Effect, Model};

/// A campaign and a model to be held against it.
pub struct Comparison<'a> {
    /// The campaign.
    pub experiment: &'a Experiment,
    model: &'a Model,
    weights: Weights,
}

impl<'a> Comparison<'a> {
    /// Yardsticks of the model as it is.
    #[must_use]
    pub fn new(experiment: &'a Experiment, model: &'a Model) -> Self {
        let estimate = Estimate::new(experiment, model.effects.clone());
        Self {
            experiment,
            model,
            weights: Weights::new(Problem::new(experiment, model), &estimate),
        }
    }

    /// Simulates every run with some effects.
    #[must_use]
    pub fn traces(&self, effects: &[AddedEffect]) -> Vec<Trace> {
        let model = self.model.with_effects(effects.to_vec());
        let runs = self.experiment.runs.iter();
        runs.map(|run| run.simulate(&model, Nuisance::default(), &Clocks::default()))
            .collect()
    }

    /// Residuals of one channel of one run, in sigmas; not a number where nothing can be compared.
    #[must_use]
    pub fn residuals(&self, run: usize, channel: Channel, trace: &Trace) -> Vec<f64> {
        let ready = &self.experiment.runs[run];
        let Some(measured) = &ready.measured[channel.index()] else {
            return vec![f64::NAN; ready.len()];
        };
        let offset = channel.index() * ready.len();
        let scale = &self.weights.runs[run].scale[offset..offset + ready.len()];
        measured
            .iter()
            .zip(trace.channel(channel))
            .zip(scale)
            .map(|((measured, simulated), scale)| {
                if *scale > 0.0 {
                    (measured - simulated) * scale
                } else {
                    f64::NAN
                }
            })
            .collect()
    }

    /// The same with the walk taken out that the currents' noise makes of the angle.
    #[must_use]
    pub fn filtered(&self, run: usize, channel: Channel, trace: &Trace) -> Vec<f64> {
        let ready = &self.experiment.runs[run];
        let part = channel.index() * ready.len()..(channel.index() + 1) * ready.len();
        let weights = &self.weights.runs[run];
        let mut filtered = weights.whiten(ready, trace)[part.clone()].to_vec();
        for (value, scale) in filtered.iter_mut().zip(&weights.scale[part]) {
            if *scale == 0.0 {
                *value = f64::NAN;
            }
        }
        filtered
    }

    /// All filtered residuals of all channels and runs with some effects.
    #[must_use]
    pub fn all(&self, effects: &[AddedEffect]) -> Vec<f64> {
        let traces = self.traces(effects);
        let parts = traces.iter().enumerate().flat_map(|(run, trace)| {
            Channel::ALL.map(|channel| self.filtered(run, channel, trace))
        });
        parts.flatten().filter(|value| value.is_finite()).collect()
    }

    /// Effects of the catalogue that this model's plant can have.
    pub fn effects(&self) -> impl Iterator<Item = &'static dyn Effect> {
        let dynamics = self.model.constants().dynamics;
        let known = CATALOGUE.iter().copied();
        known.filter(move |effect| effect.needs().is_none_or(|needed| needed == dynamics))
    }
}

/// Sums of squares and numbers of samples by channel, for an error that weights channels alike.
#[derive(Debug, Clone, Copy, Default)]
pub struct ErrorSums {
    squares: [f64; 4],
    counts: [usize; 4],
}

impl ErrorSums {
    /// Counts a channel's residuals in; those that are not numbers are left out.
    pub fn add(&mut self, channel: Channel, residuals: impl IntoIterator<Item = f64>) {
        for value in residuals.into_iter().filter(|value| value.is_finite()) {
            self.squares[channel.index()] += value * value;
            self.counts[channel.index()] += 1;
        }
    }

    /// Root mean square over channels that have samples.
    #[must_use]
    pub fn error(&self) -> f64 {
        let means: Vec<f64> = self
            .squares
            .iter()
            .zip(self.counts)
            .filter(|(_, count)| *count > 0)
            .map(|(square, count)| square / count as f64)
            .collect();
        (means.iter().sum::<f64>() / means.len() as f64).sqrt()
    }
}
