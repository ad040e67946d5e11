//! Cache of fine scans across the rounds of a search.
//!
//! An effect that reduces the cost little leaves the local minima of the others in place, so a new scan would find the
//! same.

use std::collections::HashMap;
use std::sync::{Mutex, PoisonError};

use hitch_plant::{AddedEffect, Effect};

/// Ratio of the cost to that of the cached scan below which a scan is repeated.
const RESCAN_RATIO: f64 = 0.7;

/// An effect in one of its forms.
type Name = (&'static str, Option<&'static str>);

/// The latest scan for each effect.
#[derive(Debug, Default)]
pub struct Scans {
    latest: Mutex<HashMap<Name, CachedScan>>,
}

/// The result of a scan.
#[derive(Debug, Clone)]
struct CachedScan {
    /// Cost of the fit that was scanned around.
    cost: f64,
    found: Vec<AddedEffect>,
}

impl Scans {
    /// The result of a scan for an effect around a fit of some cost: the cached one unless the cost has dropped by much
    /// since.
    pub(crate) fn of(
        &self,
        effect: &'static dyn Effect,
        cost: f64,
        search: impl FnOnce() -> Vec<AddedEffect>,
    ) -> Vec<AddedEffect> {
        let name = (effect.id(), effect.form());
        if let Some(latest) = self.latest(name)
            && cost > RESCAN_RATIO * latest.cost
        {
            return latest.found;
        }
        let found = search();
        let latest = CachedScan {
            cost,
            found: found.clone(),
        };
        self.lock().insert(name, latest);
        found
    }

    fn latest(&self, name: Name) -> Option<CachedScan> {
        self.lock().get(&name).cloned()
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, HashMap<Name, CachedScan>> {
        // Every insertion is atomic, so the map is valid even after a panic.
        self.latest.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
