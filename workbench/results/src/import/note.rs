//! What was assumed of a column, or why it is left out.

use std::fmt;

/// A line about a column.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Note {
    /// What was assumed, or the column with the reason why it is left out.
    pub what: String,
    /// What changes it on the command line; the page has its table for that.
    pub hint: Option<String>,
}

impl Note {
    /// A line that needs no correction.
    #[must_use]
    pub fn plain(what: String) -> Self {
        Self { what, hint: None }
    }
}

impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.hint {
            Some(hint) => write!(f, "{}; {hint}", self.what),
            None => f.write_str(&self.what),
        }
    }
}
