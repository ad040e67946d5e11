//! An entry of the dictionary: a change of the model and its effect on the residuals.

use hitch_plant::AddedEffect;

use crate::estimate::Estimate;

/// A share within this distance of one counts as the simulated size.
const AS_SIMULATED: f64 = 0.1;

/// How an entry changes the model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Adds an effect that the model does not have.
    New,
    /// Keeps an effect that the search has already added, by its index.
    Present(usize),
    /// Changes the size of an effect that the model had before the search, by its index.
    Change(usize),
}

/// A column of the dictionary: an effect at one size, simulated.
#[derive(Debug, Clone)]
pub(crate) struct Entry {
    /// Kind of the change.
    pub kind: Kind,
    /// The effect at the end of the secant.
    pub added: AddedEffect,
    /// Its size at the start of the secant: its null value, or its adopted size.
    pub off: f64,
    /// Decrease of the whitened residuals from the start of the secant to its end, by run.
    pub change: Vec<Vec<f64>>,
    /// Bounds of the share of the secant: the range of the size and the trust region.
    pub share: (f64, f64),
}

impl Entry {
    /// Entries with the same id exclude each other.
    pub fn id(&self) -> &'static str {
        self.added.effect.id()
    }

    /// The effect at a share of the secant.
    pub fn at(&self, share: f64) -> AddedEffect {
        let mut added = self.added.clone();
        added.values[0] = self.off + share * (added.values[0] - self.off);
        added
    }

    /// Share of the secant at which a fit starts if a subset has this share: a new rough effect starts at exactly the
    /// simulated size.
    pub fn start(&self, share: f64) -> f64 {
        let jumps = self.kind == Kind::New && self.added.effect.size_response().is_rough();
        if jumps && (share - 1.0).abs() < AS_SIMULATED {
            1.0
        } else {
            share
        }
    }

    /// Number of free parameters in a fit.
    pub fn parameters(&self) -> usize {
        match self.kind {
            Kind::Change(_) => 1,
            Kind::New | Kind::Present(_) => self.added.values.len(),
        }
    }
}

/// An estimate with exactly these entries at these shares: other added effects are removed, and other changed effects
/// return to their adopted sizes.
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
