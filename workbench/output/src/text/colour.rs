//! Colours of words that need attention. They are removed where standard output is not a terminal, see
//! [`crate::print`]: every text has to be clear without them.

use anstyle::{AnsiColor, Style};

/// For a result that is good.
pub const GOOD: Style = AnsiColor::Green.on_default();
/// For a result that needs attention.
pub const NOTABLE: Style = AnsiColor::Yellow.on_default();
/// For a result that is bad.
pub const BAD: Style = AnsiColor::Red.on_default().bold();

/// Error from which a cell needs attention, in sigma; below it is noise.
const NOTABLE_SIGMA: f64 = 1.2;
/// Error from which a cell is bad, in sigma.
const BAD_SIGMA: f64 = 3.0;

/// A text in a colour. The text has to be one word, as a line may be broken at a space.
#[must_use]
pub fn painted(style: Style, text: &str) -> String {
    format!("{style}{text}{style:#}")
}

/// A text in the colour of an error in sigma.
#[must_use]
pub fn by_sigma(text: &str, error: f64) -> String {
    match error {
        error if error >= BAD_SIGMA => painted(BAD, text),
        error if error >= NOTABLE_SIGMA => painted(NOTABLE, text),
        _ => text.to_owned(),
    }
}

/// An error in sigma with two decimals, in its colour.
#[must_use]
pub fn sigma(error: f64) -> String {
    by_sigma(&format!("{error:.2}"), error)
}

/// The name of a verdict in its colour.
#[must_use]
pub fn verdict(name: &str) -> String {
    let style = match name {
        "nothing-missing" | "explained" => GOOD,
        "unexplained" => BAD,
        _ => NOTABLE,
    };
    painted(style, name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_has_no_colour() {
        assert_eq!(by_sigma("1.03", 1.03), "1.03");
        assert_eq!(by_sigma("-", f64::NAN), "-");
        assert_ne!(by_sigma("1.50", 1.5), by_sigma("1.50", 15.0));
    }
}
