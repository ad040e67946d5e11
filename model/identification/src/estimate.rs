//! The free parameters of a fit, and their scaling.

use std::collections::BTreeSet;

use hitch_plant::{AddedEffect, Model, Parameter, SizeResponse};
use nalgebra::DVector;

use crate::constants::free::FreeConstants;
use crate::data::clocks::{Clocks, OFFSET_PRIOR_S};
use crate::data::experiment::Experiment;
use crate::data::nuisance::{LOAD_PRIOR, Nuisance};

/// A Gauss-Newton step with Levenberg-Marquardt damping.
#[derive(Debug, Clone)]
pub struct Step {
    /// Steps of the shared parameters, in units of their scales.
    pub shared: DVector<f64>,
    /// Steps of each run's load error, in prior sigmas.
    pub loads: Vec<f64>,
}

/// Values of all free parameters: those of the effects, and the nuisance parameters, which have priors.
#[derive(Debug, Clone)]
pub struct Estimate {
    /// The model's effects with their present values.
    pub effects: Vec<AddedEffect>,
    /// Offsets of the log's clocks.
    pub clocks: Clocks,
    /// Effects that the model had before the search, with the sizes they had then.
    pub adopted: Vec<Adopted>,
    /// Single parameters that a fit keeps: id of the effect, and index of the parameter.
    pub fixed: BTreeSet<(&'static str, usize)>,
    /// Nuisance parameters of each run.
    pub nuisances: Vec<Nuisance>,
    /// Largest clock offset between a channel and the currents, s.
    pub clocks_within_s: f64,
    /// Errors of the model's constants; `None` if the declared constants count as exact.
    pub constants: Option<FreeConstants>,
}

/// Bound on a load error, in prior sigmas.
const LOAD_BOUND: f64 = 5.0;

/// Rounding error of a load error converted to prior sigmas and back.
const ROUNDING: f64 = 1e-9;

/// An effect that a model had before a search.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Adopted {
    /// Its id.
    pub id: &'static str,
    /// Its size before the search, in the unit of its parameter.
    pub size: f64,
    /// Which of its parameters a fit holds fixed.
    pub held: Held,
}

/// Which parameters of an effect keep their values in a fit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Held {
    /// All of them.
    All,
    /// All but the size.
    Shape,
}

/// A parameter that all runs share.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shared {
    /// Parameter of an effect, by the two indices.
    Effect(usize, usize),
    /// Clock offset of a channel, by its index, s; positive if stamped late.
    Offset(usize),
    /// Error of the constants along a direction of their prior, by its index, in tolerances.
    Constants(usize),
}

/// The clock offsets, in the order of their columns.
pub const CLOCKS: [Shared; 4] = [
    Shared::Offset(0),
    Shared::Offset(1),
    Shared::Offset(2),
    Shared::Offset(3),
];

impl Shared {
    /// Whether it is a nuisance parameter; its prior has mean zero and a standard deviation of one scale.
    #[must_use]
    pub fn has_prior(self) -> bool {
        !matches!(self, Self::Effect(..))
    }
}

impl Estimate {
    /// The model with these effects, and with the constants of this estimate.
    #[must_use]
    pub fn applied_to(&self, model: &Model) -> Model {
        let effects = self.effects.clone();
        match &self.constants {
            Some(constants) => constants.corrected(effects),
            None => model.with_effects(effects),
        }
    }

    /// The same estimate with all constants of a model free. One sigma of their prior is this share of their tolerances.
    #[must_use]
    pub fn with_free_constants(mut self, model: &Model, share: f64) -> Self {
        let constants = self.constants.take();
        let constants = constants.unwrap_or_else(|| FreeConstants::of(model));
        self.constants = Some(constants.within(share));
        self
    }

    /// The same estimate with other constants.
    #[must_use]
    pub fn with_constants(self, constants: Option<FreeConstants>) -> Self {
        Self { constants, ..self }
    }

    /// The same estimate with its constants held in a fit or free.
    #[must_use]
    pub fn with_constants_held(mut self, is_held: bool) -> Self {
        self.constants = self.constants.map(|constants| constants.held(is_held));
        self
    }

    /// The given effects, with zero clock offsets and load errors.
    #[must_use]
    pub fn new(experiment: &Experiment, effects: Vec<AddedEffect>) -> Self {
        Self {
            effects,
            clocks: Clocks::default(),
            adopted: Vec::new(),
            fixed: BTreeSet::new(),
            nuisances: vec![Nuisance::default(); experiment.runs.len()],
            clocks_within_s: experiment.clocks_within_s,
            constants: None,
        }
    }

    /// All free shared parameters: those of the effects, then [`CLOCKS`], then the errors of the constants.
    #[must_use]
    pub fn shared(&self) -> Vec<Shared> {
        let effects = self.effects.iter().enumerate().flat_map(|(effect, added)| {
            let free = self.free_parameters(added.effect.id());
            let parameters = 0..added.values.len().min(free);
            let parameters = parameters
                .filter(|&parameter| !self.fixed.contains(&(added.effect.id(), parameter)));
            parameters.map(move |parameter| Shared::Effect(effect, parameter))
        });
        let constants = (0..self.constant_directions()).map(Shared::Constants);
        effects.chain(CLOCKS).chain(constants).collect()
    }

    /// Number of free directions of the constants.
    #[must_use]
    pub fn constant_directions(&self) -> usize {
        let constants = self.constants.as_ref();
        constants.map_or(0, FreeConstants::free)
    }

    /// Number of free parameters of an effect, the size first; `usize::MAX` if all are free. Single fixed parameters count
    /// as free.
    #[must_use]
    pub fn free_parameters(&self, id: &str) -> usize {
        match self.adopted_as(id).map(|adopted| adopted.held) {
            None => usize::MAX,
            Some(Held::Shape) => 1,
            Some(Held::All) => 0,
        }
    }

    /// The same estimate with all its effects adopted: a fit holds them fixed.
    #[must_use]
    pub fn with_adopted(mut self) -> Self {
        let adopted = |added: &AddedEffect| Adopted {
            id: added.effect.id(),
            size: added.values[0],
            held: Held::All,
        };
        self.adopted = self.effects.iter().map(adopted).collect();
        self
    }

    /// Frees the size of an adopted effect.
    pub fn release(&mut self, id: &str) {
        let mut adopted = self.adopted.iter_mut();
        if let Some(adopted) = adopted.find(|adopted| adopted.id == id) {
            adopted.held = Held::Shape;
        }
    }

    /// The adopted state of an effect; `None` if it was not adopted.
    #[must_use]
    pub fn adopted_as(&self, id: &str) -> Option<&Adopted> {
        self.adopted.iter().find(|adopted| adopted.id == id)
    }

    /// Whether an effect, by its index, is adopted and held fixed.
    #[must_use]
    pub fn is_unchanged(&self, effect: usize) -> bool {
        let adopted = self.adopted_as(self.effects[effect].effect.id());
        adopted.is_some_and(|adopted| adopted.held == Held::All)
    }

    /// Indices of the effects that were added, and of the adopted effects that are not held fixed.
    pub fn changed(&self) -> impl Iterator<Item = usize> {
        (0..self.effects.len()).filter(|&index| !self.is_unchanged(index))
    }

    /// Size at which an effect, by its index, counts as absent: its adopted size, or its null value.
    #[must_use]
    pub fn off(&self, effect: usize) -> f64 {
        let own = self.effects[effect].effect;
        let adopted = self.adopted_as(own.id());
        adopted.map_or(own.parameters()[0].null, |adopted| adopted.size)
    }

    /// Description of an effect's parameter.
    #[must_use]
    pub fn parameter(&self, effect: usize, parameter: usize) -> &'static Parameter {
        &self.effects[effect].effect.parameters()[parameter]
    }

    /// How the simulated channels respond to a shared parameter. Only the size of a located effect is located; its
    /// other parameters respond smoothly.
    #[must_use]
    pub fn size_response(&self, shared: Shared) -> SizeResponse {
        match shared {
            Shared::Effect(effect, parameter) => {
                match self.effects[effect].effect.size_response() {
                    SizeResponse::Located if parameter > 0 => SizeResponse::Smooth,
                    response => response,
                }
            }
            Shared::Offset(_) | Shared::Constants(_) => SizeResponse::Smooth,
        }
    }

    /// Scale of a shared parameter, in its unit. Steps of a fit are given in scales.
    #[must_use]
    pub fn scale(&self, shared: Shared) -> f64 {
        match shared {
            Shared::Effect(effect, parameter) => self.parameter(effect, parameter).scale(),
            Shared::Offset(_) => OFFSET_PRIOR_S,
            Shared::Constants(_) => {
                let constants = self.constants.as_ref();
                constants.map_or(1.0, FreeConstants::share)
            }
        }
    }

    /// Value of a shared parameter, in its unit.
    #[must_use]
    pub fn get(&self, shared: Shared) -> f64 {
        match shared {
            Shared::Effect(effect, parameter) => self.effects[effect].values[parameter],
            Shared::Offset(channel) => self.clocks.offsets_s[channel],
            Shared::Constants(direction) => {
                let constants = self.constants.as_ref();
                constants.map_or(0.0, |constants| constants.errors()[direction])
            }
        }
    }

    /// Distances from the value of a shared parameter to the lower and upper end of its range, in scales.
    #[must_use]
    pub fn room(&self, shared: Shared) -> (f64, f64) {
        let (low, high) = self.range(shared);
        let (value, scale) = (self.get(shared), self.scale(shared));
        ((low - value) / scale, (high - value) / scale)
    }

    /// Smallest and largest value of a shared parameter, in its unit.
    #[must_use]
    pub fn range(&self, shared: Shared) -> (f64, f64) {
        match shared {
            Shared::Effect(effect, parameter) => {
                let range = self.parameter(effect, parameter);
                (range.low, range.high)
            }
            Shared::Offset(_) => (-self.clocks_within_s, self.clocks_within_s),
            Shared::Constants(_) => {
                let constants = self.constants.as_ref();
                let farthest = constants.map_or(0.0, FreeConstants::farthest);
                (-farthest, farthest)
            }
        }
    }

    /// Whether a shared parameter is at an end of its range.
    #[must_use]
    pub fn is_at_an_end(&self, shared: Shared) -> bool {
        let (value, (low, high)) = (self.get(shared), self.range(shared));
        value <= low || value >= high
    }

    /// Sets a shared parameter, clamped to its range.
    pub fn set(&mut self, shared: Shared, value: f64) {
        let (low, high) = self.range(shared);
        let value = value.max(low).min(high);
        match shared {
            Shared::Effect(effect, parameter) => self.effects[effect].values[parameter] = value,
            Shared::Offset(channel) => self.clocks.offsets_s[channel] = value,
            Shared::Constants(direction) => {
                if let Some(constants) = &mut self.constants {
                    constants.set(direction, value);
                }
            }
        }
    }

    /// The estimate after a step, clamped to all ranges.
    #[must_use]
    pub fn moved(&self, parameters: &[Shared], step: &Step) -> Self {
        let mut moved = self.clone();
        let constants = self.constants.as_ref();
        let mut errors = constants.map_or(Vec::new(), |constants| constants.errors().to_vec());
        for (&shared, &scales) in parameters.iter().zip(step.shared.iter()) {
            match shared {
                Shared::Constants(direction) => errors[direction] += scales * self.scale(shared),
                Shared::Effect(..) | Shared::Offset(_) => {
                    moved.set(shared, self.get(shared) + scales * self.scale(shared));
                }
            }
        }
        if let Some(constants) = &mut moved.constants {
            constants.set_all(errors);
        }
        for (run, &sigmas) in step.loads.iter().enumerate() {
            moved.set_load(run, self.load(run) + sigmas);
        }
        moved
    }

    /// The step from another estimate to this one: shorter than the step asked for if a range clamped it.
    #[must_use]
    pub fn step_from(&self, from: &Self, parameters: &[Shared]) -> Step {
        let shared = parameters
            .iter()
            .map(|&shared| (self.get(shared) - from.get(shared)) / self.scale(shared));
        let loads = (0..self.nuisances.len()).map(|run| self.load(run) - from.load(run));
        Step {
            shared: DVector::from_iterator(parameters.len(), shared),
            loads: loads.collect(),
        }
    }

    /// Load error of a run, in prior sigmas.
    #[must_use]
    pub fn load(&self, run: usize) -> f64 {
        self.nuisances[run].load / LOAD_PRIOR
    }

    /// Whether a run's load error is at an end of its range and the gradient `pull` of the residuals, in cost per
    /// sigma, points outwards.
    #[must_use]
    pub fn load_would_leave(&self, run: usize, pull: f64) -> bool {
        let load = self.load(run);
        load.abs() >= LOAD_BOUND - ROUNDING && (pull - load) * load > 0.0
    }

    /// Sets the load error of a run, in prior sigmas.
    pub fn set_load(&mut self, run: usize, sigmas: f64) {
        self.nuisances[run].load = sigmas.clamp(-LOAD_BOUND, LOAD_BOUND) * LOAD_PRIOR;
    }

    /// The estimate without one of the effects, by its index. An adopted effect returns to its adopted size instead.
    #[must_use]
    pub fn without(&self, effect: usize) -> Self {
        let mut reduced = self.clone();
        let id = self.effects[effect].effect.id();
        let mut adopted = reduced.adopted.iter_mut();
        match adopted.find(|adopted| adopted.id == id) {
            Some(adopted) => {
                adopted.held = Held::All;
                reduced.effects[effect].values[0] = adopted.size;
            }
            None => {
                reduced.effects.remove(effect);
            }
        }
        reduced
    }

    /// Cost of the priors: squared distance in prior sigmas.
    #[must_use]
    pub fn prior_cost(&self) -> f64 {
        let loads: f64 = self
            .nuisances
            .iter()
            .map(|nuisance| (nuisance.load / LOAD_PRIOR).powi(2))
            .sum();
        let clocks: f64 = CLOCKS
            .iter()
            .map(|&clock| (self.get(clock) / self.scale(clock)).powi(2))
            .sum();
        let constants = self.constants.as_ref();
        loads + clocks + constants.map_or(0.0, FreeConstants::prior_cost)
    }
}
