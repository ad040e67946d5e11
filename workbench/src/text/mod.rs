//! Text for a terminal: tables, wrapped lines, numbers and colours.
use std::path::Path;

pub mod colour;
mod table;
mod width;
pub mod words;

pub use table::Table;
pub use width::{indented, visible, width, wrapped};

/// A number with a fixed number of decimals; a dash for NaN.
#[must_use]
pub fn known(value: f64, decimals: usize) -> String {
    if value.is_finite() {
        format!("{value:.decimals$}")
    } else {
        "-".to_owned()
    }
}

/// A path as one word of a shell, for a command to copy.
#[must_use]
pub fn shell_word(path: &Path) -> String {
    let text = path.to_string_lossy();
    shlex::try_quote(&text).map_or_else(|_| text.to_string(), |quoted| quoted.into_owned())
}
