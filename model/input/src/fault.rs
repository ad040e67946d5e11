//! What is wrong with a formula or a unit, where, and how to mend it.

use std::fmt;

/// A fault of a text that somebody wrote.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault {
    /// Byte of the text where it is.
    pub byte: usize,
    /// Column of that byte, counted from 1 in characters.
    pub column: usize,
    /// What is wrong.
    pub what: String,
    /// How to mend it.
    pub mend: String,
}

impl Fault {
    /// A fault at a byte of `text`.
    pub fn at(text: &str, byte: usize, what: impl Into<String>, mend: impl Into<String>) -> Self {
        let before = text.char_indices().take_while(|(at, _)| *at < byte);
        Self {
            byte,
            column: before.count() + 1,
            what: what.into(),
            mend: mend.into(),
        }
    }

    /// The same fault of a text that holds the other one from `byte` on.
    #[must_use]
    pub fn inside(self, text: &str, byte: usize) -> Self {
        Self::at(text, byte + self.byte, self.what, self.mend)
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "column {}: {}; {}", self.column, self.what, self.mend)
    }
}

impl std::error::Error for Fault {}

/// A piece of a formula for a message: as it stands, between backquotes, cut where it gets long.
#[must_use]
pub fn shown(piece: &str) -> String {
    const LONGEST: usize = 48;
    let mut shown: String = piece.chars().take(LONGEST).collect();
    if shown.len() < piece.len() {
        shown.push('…');
    }
    format!("`{shown}`")
}
