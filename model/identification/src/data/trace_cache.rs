//! Cache of the latest simulated traces of a run.
//!
//! Two of five simulations of a search would be repetitions: the base point of difference quotients, load errors of a
//! flow bench, clock offsets that shift a channel without changing the plant.

use std::hash::{Hash, Hasher};
use std::sync::Arc;

use hitch_plant::simulation::Trace;
use hitch_plant::{AddedEffect, Constants, Model};
use quick_cache::sync::Cache;

use crate::data::nuisance::{CurrentShift, Nuisance};

/// Samples of cached traces of all runs together, about 100 MB, and of one run at most, about 5 MB.
const KEPT_SAMPLES: usize = 2_400_000;
const KEPT_OF_A_RUN: usize = 120_000;

/// Fewest cached traces of a run, regardless of their length.
const FEWEST_KEPT: usize = 6;

/// Everything that the trace of a run depends on.
#[derive(Debug, Clone)]
struct TraceKey {
    /// Keeps the constants alive, so that their address stays unique.
    constants: Arc<Constants>,
    /// Effects in order of action: id, address, bits of the values.
    effects: Vec<(&'static str, usize, Vec<u64>)>,
    /// Bits of the load error and of the shift.
    numbers: [u64; 3],
}

impl TraceKey {
    /// Positive and negative zero are the same key.
    fn new(model: &Model, nuisance: Nuisance, shift: CurrentShift) -> Self {
        let bits = |value: f64| (value + 0.0).to_bits();
        // An effect at its null value has no influence.
        let present = model.effects.iter().filter(|added| !added.is_null());
        let effect = |added: &AddedEffect| {
            let address = std::ptr::from_ref(added.effect).addr();
            let values = added.values.iter().copied().map(bits).collect();
            (added.effect.id(), address, values)
        };
        Self {
            constants: Arc::clone(model.shared_constants()),
            effects: present.map(effect).collect(),
            numbers: [nuisance.load, shift.later_s, shift.spreads].map(bits),
        }
    }

    fn constants_address(&self) -> usize {
        Arc::as_ptr(&self.constants).addr()
    }
}

impl PartialEq for TraceKey {
    fn eq(&self, other: &Self) -> bool {
        self.constants_address() == other.constants_address()
            && self.numbers == other.numbers
            && self.effects == other.effects
    }
}

impl Eq for TraceKey {}

impl Hash for TraceKey {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.constants_address().hash(state);
        self.numbers.hash(state);
        self.effects.hash(state);
    }
}

/// The latest traces of a run, shared by clones.
#[derive(Debug, Clone)]
pub(crate) struct Traces {
    kept: Arc<Cache<TraceKey, Arc<Trace>>>,
    /// Samples that the cache may hold.
    room: usize,
}

impl Traces {
    /// An empty cache for a run of this many samples, one of `runs`.
    pub fn new(samples: usize, runs: usize) -> Self {
        Self::within(KEPT_OF_A_RUN.min(KEPT_SAMPLES / runs.max(1)), samples)
    }

    /// An empty cache for the same run with other conditions and this many samples.
    pub fn emptied(&self, samples: usize) -> Self {
        Self::within(self.room, samples)
    }

    fn within(room: usize, samples: usize) -> Self {
        let traces = (room / samples.max(1)).max(FEWEST_KEPT);
        Self {
            kept: Arc::new(Cache::new(traces)),
            room,
        }
    }

    /// The cached trace of a model with a nuisance and a shift of the currents; `simulate` computes it if it is
    /// missing.
    pub fn trace(
        &self,
        model: &Model,
        nuisance: Nuisance,
        shift: CurrentShift,
        simulate: impl FnOnce() -> Trace,
    ) -> Arc<Trace> {
        let key = TraceKey::new(model, nuisance, shift);
        // A plain look-up: waiting for another thread that computes the same trace would cost more than computing it
        // twice.
        if let Some(trace) = self.kept.get(&key) {
            return trace;
        }
        let trace = Arc::new(simulate());
        self.kept.insert(key, Arc::clone(&trace));
        trace
    }
}
