//! Options of a search.

use crate::constants::tolerances::Tolerances;
use crate::data::limit::Limit;
use crate::estimation::fit::Fit;

/// How accurate the constants of a model are.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Accuracy {
    /// Unknown: as exact as those of any model, or off by a share of the tolerances of data sheets; the campaign decides. Beside
    /// a baseline they are as they were on it.
    #[default]
    Unknown,
    /// That of a data sheet: they are fitted together with the effects, within [`Options::tolerances`].
    DataSheet,
}

/// Options of a search.
#[derive(Clone, Copy)]
pub struct Options<'a> {
    /// Whether the sizes of effects that the model had before the search may change.
    pub changes: bool,
    /// How accurate the constants of the model are.
    pub constants: Accuracy,
    /// Own tolerances of the constants of a data sheet; `None` for the usual ones.
    pub tolerances: Option<&'a Tolerances>,
    /// Until when the search goes on; then it returns its best result so far.
    pub limit: Limit<'a>,
    /// Callback with each fit that becomes the best one during the search.
    pub improved: &'a (dyn Fn(&Fit) + Sync),
}

impl Default for Options<'_> {
    fn default() -> Self {
        Self {
            changes: true,
            constants: Accuracy::default(),
            tolerances: None,
            limit: Limit::default(),
            improved: &|_| {},
        }
    }
}

impl std::fmt::Debug for Options<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Options")
            .field("changes", &self.changes)
            .field("constants", &self.constants)
            .field("limit", &self.limit)
            .finish_non_exhaustive()
    }
}

impl Options<'_> {
    /// Whether the deadline has passed.
    #[must_use]
    pub fn is_over(&self) -> bool {
        self.limit.is_over()
    }
}
