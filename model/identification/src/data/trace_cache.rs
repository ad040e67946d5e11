//! Simulated traces of one run, the latest ones kept.
//!
//! Two simulations in five of a search would repeat one that there was already: the point that difference quotients
//! start from, a load that a flow bench does not have, clocks that move a channel but not the plant.

use std::hash::{Hash, Hasher};
use std::sync::Arc;

use hitch_plant::simulation::Trace;
use hitch_plant::{AddedEffect, Constants, Model};
use quick_cache::sync::Cache;

use crate::data::experiment::Nuisance;

/// Samples of traces that are kept for one run: some 5 MB.
const KEPT_SAMPLES: usize = 120_000;

/// Fewest traces that are kept, however long they are.
const FEWEST_KEPT: usize = 6;

/// How the currents that drive a simulation differ from the cleaned ones.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct CurrentShift {
    /// How much later the valves felt them, s.
    pub later_s: f64,
    /// How many of their sigmas they are off.
    pub spreads: f64,
}

/// Everything that a trace of one run depends on.
#[derive(Debug, Clone)]
struct Key {
    /// Kept alive, so that its address stays its own.
    constants: Arc<Constants>,
    /// Effects in the order in which they act: name, address, bits of the values.
    effects: Vec<(&'static str, usize, Vec<u64>)>,
    /// Bits of the load error and of the shift.
    numbers: [u64; 3],
}

impl Key {
    /// Zero of either sign is one number.
    fn new(model: &Model, nuisance: Nuisance, shift: CurrentShift) -> Self {
        let bits = |value: f64| (value + 0.0).to_bits();
        // An effect at its null value is not there at all.
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

impl PartialEq for Key {
    fn eq(&self, other: &Self) -> bool {
        self.constants_address() == other.constants_address()
            && self.numbers == other.numbers
            && self.effects == other.effects
    }
}

impl Eq for Key {}

impl Hash for Key {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.constants_address().hash(state);
        self.numbers.hash(state);
        self.effects.hash(state);
    }
}

/// The latest traces of a run; clones share them.
#[derive(Debug, Clone)]
pub(crate) struct Traces {
    kept: Arc<Cache<Key, Arc<Trace>>>,
}

impl Traces {
    /// Nothing yet of a run of so many samples.
    pub fn new(samples: usize) -> Self {
        let traces = (KEPT_SAMPLES / samples.max(1)).max(FEWEST_KEPT);
        Self {
            kept: Arc::new(Cache::new(traces)),
        }
    }

    /// The trace of a model under a nuisance and currents that are off; `simulate` makes it if it is not there.
    pub fn trace(
        &self,
        model: &Model,
        nuisance: Nuisance,
        shift: CurrentShift,
        simulate: impl FnOnce() -> Trace,
    ) -> Arc<Trace> {
        let key = Key::new(model, nuisance, shift);
        // Looked for first: to wait for another thread that makes the same one would cost more than to make it twice.
        if let Some(trace) = self.kept.get(&key) {
            return trace;
        }
        let trace = Arc::new(simulate());
        self.kept.insert(key, Arc::clone(&trace));
        trace
    }
}
