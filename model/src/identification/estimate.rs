//! What a fit may change, and its scaling.

use super::experiment::{Experiment, LOAD_PRIOR, Nuisance, SKEW_PRIOR_S};
use super::jacobian::Step;
use crate::effects::{AddedEffect, Parameter};

/// Values of everything that is free: the effects' parameters, and the nuisances with a prior.
#[derive(Debug, Clone)]
pub struct Estimate {
    /// The model's effects with their present values.
    pub effects: Vec<AddedEffect>,
    /// How far the log's currents are ahead of its other channels, s.
    pub skew_s: f64,
    /// What each run may be off by.
    pub nuisances: Vec<Nuisance>,
}

/// A nuisance is never believed to be further off than this many prior sigmas.
const FARTHEST: f64 = 5.0;

/// A parameter that all runs share.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shared {
    /// Parameter of an effect, by the two indices.
    Effect(usize, usize),
    /// The skew.
    Skew,
}

impl Estimate {
    /// The effects as they are, nothing off.
    #[must_use]
    pub fn new(experiment: &Experiment, effects: Vec<AddedEffect>) -> Self {
        Self {
            effects,
            skew_s: 0.0,
            nuisances: vec![Nuisance::default(); experiment.runs.len()],
        }
    }

    /// Every shared parameter that is free, effects first, the skew last.
    #[must_use]
    pub fn shared(&self) -> Vec<Shared> {
        let effects = self.effects.iter().enumerate().flat_map(|(effect, added)| {
            (0..added.values.len()).map(move |parameter| Shared::Effect(effect, parameter))
        });
        effects.chain([Shared::Skew]).collect()
    }

    /// Description of an effect's parameter.
    #[must_use]
    pub fn parameter(&self, effect: usize, parameter: usize) -> &'static Parameter {
        &self.effects[effect].effect.parameters()[parameter]
    }

    /// A natural size of a shared parameter, in its unit: its step in a fit is one of these.
    #[must_use]
    pub fn scale(&self, shared: Shared) -> f64 {
        match shared {
            Shared::Effect(effect, parameter) => self.parameter(effect, parameter).typical.abs(),
            Shared::Skew => SKEW_PRIOR_S,
        }
    }

    /// Value of a shared parameter, in its unit.
    #[must_use]
    pub fn get(&self, shared: Shared) -> f64 {
        match shared {
            Shared::Effect(effect, parameter) => self.effects[effect].values[parameter],
            Shared::Skew => self.skew_s,
        }
    }

    /// Sets a shared parameter, within its range.
    pub fn set(&mut self, shared: Shared, value: f64) {
        match shared {
            Shared::Effect(effect, parameter) => {
                let range = self.parameter(effect, parameter);
                self.effects[effect].values[parameter] = value.max(range.low).min(range.high);
            }
            Shared::Skew => {
                let farthest = FARTHEST * SKEW_PRIOR_S;
                self.skew_s = value.max(-farthest).min(farthest);
            }
        }
    }

    /// The estimate after a step, within all ranges.
    #[must_use]
    pub fn moved(&self, parameters: &[Shared], step: &Step) -> Self {
        let mut moved = self.clone();
        for (&shared, &scales) in parameters.iter().zip(step.shared.iter()) {
            moved.set(shared, self.get(shared) + scales * self.scale(shared));
        }
        for (run, &sigmas) in step.loads.iter().enumerate() {
            moved.set_load(run, self.load(run) + sigmas);
        }
        moved
    }

    /// Load error of a run, in prior sigmas.
    #[must_use]
    pub fn load(&self, run: usize) -> f64 {
        self.nuisances[run].load / LOAD_PRIOR
    }

    /// Sets the load error of a run, in prior sigmas.
    pub fn set_load(&mut self, run: usize, sigmas: f64) {
        self.nuisances[run].load = sigmas.clamp(-FARTHEST, FARTHEST) * LOAD_PRIOR;
    }

    /// Cost of the priors: squared distance in prior sigmas.
    #[must_use]
    pub fn prior_cost(&self) -> f64 {
        let loads: f64 = self
            .nuisances
            .iter()
            .map(|nuisance| (nuisance.load / LOAD_PRIOR).powi(2))
            .sum();
        loads + (self.skew_s / SKEW_PRIOR_S).powi(2)
    }
}
