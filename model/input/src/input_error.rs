//! Faults of input files, with their positions.

use std::fmt;
use std::path::{Path, PathBuf};

/// A fault in an input file: what, where, and a suggested correction.
///
/// It prints as one line, `file:line:column: what; how to correct it`, regardless of the file's contents.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct InputError {
    /// The faulty file or folder.
    pub file: PathBuf,
    /// Line and column, both from 1; `None` for a fault of the whole file.
    pub place: Option<Position>,
    /// Description.
    pub what: String,
    /// Suggested correction; empty if `what` implies it.
    pub hint: String,
}

/// A position in a text file as in editors: from 1, columns in characters.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Position {
    /// Line, from 1.
    pub line: usize,
    /// Character in the line, from 1.
    pub column: usize,
}

impl InputError {
    /// A fault of the whole file.
    pub fn of_file(file: &Path, what: impl Into<String>, hint: impl Into<String>) -> Self {
        Self {
            file: file.to_path_buf(),
            place: None,
            what: what.into(),
            hint: hint.into(),
        }
    }

    /// A fault at one position of the file.
    pub fn at(
        file: &Path,
        place: Position,
        what: impl Into<String>,
        hint: impl Into<String>,
    ) -> Self {
        Self {
            place: Some(place),
            ..Self::of_file(file, what, hint)
        }
    }
}

impl fmt::Display for InputError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", one_line(&self.file.display().to_string()))?;
        if let Some(Position { line, column }) = self.place {
            write!(f, ":{line}:{column}")?;
        }
        write!(f, ": {}", one_line(&self.what))?;
        if !self.hint.is_empty() {
            write!(f, "; {}", one_line(&self.hint))?;
        }
        Ok(())
    }
}

impl std::error::Error for InputError {}

/// Quotes a part of a file for an error message: escaped, and truncated if long.
pub fn quote(text: &str) -> String {
    const LONGEST: usize = 40;
    let mut shown: String = text.chars().take(LONGEST).collect();
    if shown.len() < text.len() {
        shown.push('…');
    }
    format!("{shown:?}")
}

/// Escapes line breaks and control characters of terminals.
fn one_line(text: &str) -> String {
    let mut line = String::with_capacity(text.len());
    for c in text.chars() {
        if c.is_control() {
            line.extend(c.escape_default())
        } else {
            line.push(c)
        }
    }
    line
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prints_one_line_whatever_it_holds() {
        let place = Position { line: 3, column: 7 };
        let error = InputError::at(
            Path::new("a\nb.csv"),
            place,
            "bad\r\nthing",
            "hint\u{1b}[2J it",
        );
        assert_eq!(
            error.to_string(),
            r"a\nb.csv:3:7: bad\r\nthing; hint\u{1b}[2J it"
        );
    }

    #[test]
    fn quotes_and_cuts() {
        assert_eq!(quote("a\"b"), r#""a\"b""#);
        assert_eq!(quote(&"x".repeat(60)).chars().count(), 40 + 1 + 2);
    }
}
