//! The assignment of a log to the columns of a run.

use super::note::Note;

/// A column of a run, its source, and the reason for the choice.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Taken {
    /// The run's column.
    pub channel: &'static str,
    /// Name and unit, as in `[columns]`.
    pub source: String,
    /// Reason.
    pub reason: String,
    /// Whether name or unit is an assumption, which the user should check.
    pub is_assumed: bool,
}

impl Taken {
    pub(super) fn is_proposed(&self) -> bool {
        self.reason != BY_USER
    }
}

/// Assignment for a log.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Mapping {
    /// In the order of a run's columns.
    pub taken: Vec<Taken>,
    /// What was assumed, and columns of a known quantity that were left out; one line each.
    pub notes: Vec<Note>,
}

/// A column that could not be determined.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Undetermined {
    /// Description.
    pub what: String,
    /// Suggested correction.
    pub hint: String,
}

/// Reason of a column that the user assigned.
pub(super) const BY_USER: &str = "given by --map";
