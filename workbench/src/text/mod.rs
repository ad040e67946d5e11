//! Text for a terminal: tables, wrapped lines, numbers and colours.
use std::path::Path;

pub mod colour;
pub mod measurement;
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

/// Items as text, with a separator.
#[must_use]
pub fn joined(items: impl IntoIterator<Item: ToString>, between: &str) -> String {
    let items = items.into_iter().map(|item| item.to_string());
    items.collect::<Vec<_>>().join(between)
}

/// A path as one word of a shell, for a command to copy.
#[must_use]
pub fn shell_word(path: &Path) -> String {
    let text = path.to_string_lossy();
    shlex::try_quote(&text).map_or_else(|_| text.to_string(), |quoted| quoted.into_owned())
}

/// A number with a fixed number of significant digits.
#[must_use]
pub fn significant(value: f64, digits: i32) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let decimals = (digits - 1 - value.abs().log10().floor() as i32).clamp(0, 12);
    format!("{value:.*}", decimals as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_their_significant_digits() {
        assert_eq!(significant(0.199_04, 4), "0.1990");
        assert_eq!(significant(0.004_2, 3), "0.00420");
        assert_eq!(significant(725.4, 3), "725");
        assert_eq!(significant(0.0, 3), "0");
    }
}
