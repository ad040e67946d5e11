//! Widths of texts, and lines that fit into them.

use std::sync::OnceLock;

use anstream::adapter::strip_str;

/// Width of texts where standard output is not a terminal, and the least width on a terminal, characters.
const LEAST: usize = 80;

/// Width of texts: that of the terminal, at least 80 characters.
#[must_use]
pub fn width() -> usize {
    static WIDTH: OnceLock<usize> = OnceLock::new();
    *WIDTH.get_or_init(|| {
        let size = terminal_size::terminal_size_of(std::io::stdout());
        size.map_or(LEAST, |(width, _)| usize::from(width.0).max(LEAST))
    })
}

/// Number of characters of a text on a terminal, without colours.
#[must_use]
pub fn visible(text: &str) -> usize {
    strip_str(text).map(|part| part.chars().count()).sum()
}

/// Breaks a text at spaces into lines of at most [`width`] characters; all but the first are indented by two spaces.
#[must_use]
pub fn wrapped(text: &str) -> String {
    broken(text, width(), "", "  ")
}

/// Breaks a text as [`wrapped`] does, with every line indented, all but the first by two more spaces.
#[must_use]
pub fn indented(text: &str, spaces: usize) -> String {
    let first = " ".repeat(spaces);
    broken(text, width(), &first, &format!("{first}  "))
}

/// Breaks a text at spaces into lines of at most `width` characters. A longer word has its own line.
pub(super) fn broken(text: &str, width: usize, first: &str, others: &str) -> String {
    let mut done = String::new();
    let mut line = first.to_owned();
    let mut is_empty = true;
    for word in text.split_whitespace() {
        if !is_empty && visible(&line) + 1 + visible(word) > width {
            done.push_str(&line);
            done.push('\n');
            line = others.to_owned();
            is_empty = true;
        }
        if !is_empty {
            line.push(' ');
        }
        line.push_str(word);
        is_empty = false;
    }
    done + &line
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_texts_are_broken_between_words() {
        assert_eq!(
            broken("one two three four", 10, "", "  "),
            "one two\n  three\n  four"
        );
        assert_eq!(broken("", 10, "", "  "), "");
        assert_eq!(
            broken("one immeasurable", 8, " ", "   "),
            " one\n   immeasurable"
        );
    }

    #[test]
    fn colours_have_no_width() {
        let painted = super::super::colour::painted(super::super::colour::BAD, "bad");
        assert_eq!(visible(&painted), 3);
        assert_eq!(
            broken(&format!("{painted} word"), 8, "", "  "),
            format!("{painted} word")
        );
    }
}
