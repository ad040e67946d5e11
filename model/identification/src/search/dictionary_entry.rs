//! One way in which a model may be wrong, with what it changes.

use hitch_plant::AddedEffect;

use crate::estimate::Estimate;

/// A share this near to one is the size that was simulated.
const AS_SIMULATED: f64 = 0.1;

/// What an entry does to a model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Adds an effect that the model does not have.
    New,
    /// Keeps an effect that the search has added already, by its index.
    Present(usize),
    /// Changes the size of an effect that the model had before the search, by its index.
    Change(usize),
}

/// A column of the dictionary: an effect at one size, simulated.
#[derive(Debug, Clone)]
pub(crate) struct Entry {
    /// What it does.
    pub kind: Kind,
    /// The effect at the end of the secant.
    pub added: AddedEffect,
    /// Its size at the start of the secant: absent, or as it was adopted.
    pub off: f64,
    /// By how much the whitened residuals fall from the start of the secant to its end, by run.
    pub change: Vec<Vec<f64>>,
    /// Smallest and largest share of the secant that its range and the trust in it allow.
    pub share: (f64, f64),
}

impl Entry {
    /// Effects with the same name exclude each other.
    pub fn id(&self) -> &'static str {
        self.added.effect.id()
    }

    /// The effect at a share of the secant.
    pub fn at(&self, share: f64) -> AddedEffect {
        let mut added = self.added.clone();
        added.values[0] = self.off + share * (added.values[0] - self.off);
        added
    }

    /// The share of the secant from which a fit starts where a subset takes such a share: what jumps does so at the size
    /// that was simulated, and not beside it.
    pub fn start(&self, share: f64) -> f64 {
        let jumps = self.kind == Kind::New && self.added.effect.size_response().is_rough();
        if jumps && (share - 1.0).abs() < AS_SIMULATED {
            1.0
        } else {
            share
        }
    }

    /// Number of parameters that a fit of it finds.
    pub fn parameters(&self) -> usize {
        match self.kind {
            Kind::Change(_) => 1,
            Kind::New | Kind::Present(_) => self.added.values.len(),
        }
    }
}

/// An estimate with exactly these entries at these shares: what else the search had added is gone, and what it had
/// changed is as it was adopted.
pub(crate) fn with_entries(
    present: &Estimate,
    given: &[AddedEffect],
    entries: &[(&Entry, f64)],
) -> Estimate {
    let mut estimate = Estimate {
        effects: given.to_vec(),
        ..present.clone()
    }
    .with_adopted();
    for (entry, share) in entries {
        let added = entry.at(*share);
        let id = added.effect.id();
        let own = estimate
            .effects
            .iter()
            .position(|own| own.effect.id() == id);
        match own {
            Some(own) => {
                estimate.effects[own] = added;
                estimate.release(id);
            }
            None => estimate.effects.push(added),
        }
    }
    estimate
}
