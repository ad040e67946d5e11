//! A fault in a formula or a unit: where, what, and a suggested correction.

use std::fmt;

/// A fault in a text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault {
    /// Byte offset in the text.
    pub byte: usize,
    /// Column of that byte, in characters from 1.
    pub column: usize,
    /// Description.
    pub what: String,
    /// Suggested correction.
    pub hint: String,
}

impl Fault {
    /// A fault at a byte of `text`.
    pub fn at(text: &str, byte: usize, what: impl Into<String>, hint: impl Into<String>) -> Self {
        let before = text.char_indices().take_while(|(at, _)| *at < byte);
        Self {
            byte,
            column: before.count() + 1,
            what: what.into(),
            hint: hint.into(),
        }
    }

    /// The same fault in a text that contains this one from `byte` on.
    #[must_use]
    pub fn inside(self, text: &str, byte: usize) -> Self {
        Self::at(text, byte + self.byte, self.what, self.hint)
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "column {}: {}; {}", self.column, self.what, self.hint)
    }
}

impl std::error::Error for Fault {}

/// A part of a formula for a message, in backquotes, truncated if long.
#[must_use]
pub fn shown(piece: &str) -> String {
    const LONGEST: usize = 48;
    let mut shown: String = piece.chars().take(LONGEST).collect();
    if shown.len() < piece.len() {
        shown.push('…');
    }
    format!("`{shown}`")
}
