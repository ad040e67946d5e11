//! What fine searches found, kept from one round of adding effects to the next.
//!
//! An effect that takes little of the cost leaves the valleys of the others where they were, and looking through them
//! once more would only find the same.

use std::collections::HashMap;
use std::sync::{Mutex, PoisonError};

use hitch_plant::{AddedEffect, Effect};

/// Share of the cost under which another search may find something else.
const MUCH_LESS: f64 = 0.7;

/// An effect in one of its forms.
type Name = (&'static str, Option<&'static str>);

/// The latest search for each effect.
#[derive(Debug, Default)]
pub struct Scans {
    latest: Mutex<HashMap<Name, Scan>>,
}

/// What a search found.
#[derive(Debug, Clone)]
struct Scan {
    /// The cost of what it was made on.
    cost: f64,
    found: Vec<AddedEffect>,
}

impl Scans {
    /// What a search for an effect on a model of some cost finds: what the latest one found unless the cost is much less
    /// than it was then.
    pub(crate) fn of(
        &self,
        effect: &'static dyn Effect,
        cost: f64,
        search: impl FnOnce() -> Vec<AddedEffect>,
    ) -> Vec<AddedEffect> {
        let name = (effect.id(), effect.form());
        if let Some(latest) = self.latest(name)
            && cost > MUCH_LESS * latest.cost
        {
            return latest.found;
        }
        let found = search();
        let latest = Scan {
            cost,
            found: found.clone(),
        };
        self.lock().insert(name, latest);
        found
    }

    fn latest(&self, name: Name) -> Option<Scan> {
        self.lock().get(&name).cloned()
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, HashMap<Name, Scan>> {
        // A map that is only inserted into is whole whoever panicked.
        self.latest.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
