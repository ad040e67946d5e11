//! Tokenizer for formulas: numbers, units, names and signs.

use std::ops::Range;

use hitch_input::fault::{Fault, shown};

/// Longest formula, in bytes. It bounds the size of the tree.
const LONGEST: usize = 1000;

/// Kind of a token.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TokenKind {
    /// A number, without its unit.
    Number(f64),
    /// A unit between square brackets; the span includes them.
    Unit,
    /// The name of a signal, a parameter or a function.
    Name,
    /// One of `+ - * / ^ ( ) ,`.
    Sign(char),
    /// The end of the formula.
    End,
}

/// A token of a formula.
#[derive(Debug, Clone, PartialEq)]
pub struct Token {
    /// Its kind.
    pub kind: TokenKind,
    /// Its byte range in the formula.
    pub span: Range<usize>,
}

/// The tokens of a formula; the last one is [`TokenKind::End`].
///
/// # Errors
/// The first character that does not belong to any token.
pub fn tokens(text: &str) -> Result<Vec<Token>, Fault> {
    if text.len() > LONGEST {
        let what = format!("the formula is longer than {LONGEST} characters");
        return Err(Fault::at(text, 0, what, "write it as several terms"));
    }
    let mut tokens = Vec::new();
    let mut at = 0;
    while let Some(c) = text[at..].chars().next() {
        if c.is_whitespace() {
            at += c.len_utf8();
            continue;
        }
        let (kind, length) = token(text, at, c)?;
        let span = at..at + length;
        at = span.end;
        tokens.push(Token { kind, span });
    }
    let span = text.len()..text.len();
    tokens.push(Token {
        kind: TokenKind::End,
        span,
    });
    Ok(tokens)
}

fn token(text: &str, at: usize, first: char) -> Result<(TokenKind, usize), Fault> {
    match first {
        '0'..='9' | '.' => number(text, at),
        '[' => unit(text, at),
        '*' if text[at..].starts_with("**") => Err(Fault::at(
            text,
            at,
            "`**` is not known",
            "a power is written x^2",
        )),
        '+' | '-' | '*' | '/' | '^' | '(' | ')' | ',' => Ok((TokenKind::Sign(first), 1)),
        c if is_name(c) => {
            let length = text[at..].find(|c| !is_name(c)).unwrap_or(text.len() - at);
            Ok((TokenKind::Name, length))
        }
        c => Err(stray(text, at, c)),
    }
}

/// Characters of a name; a name does not begin with a digit.
fn is_name(c: char) -> bool {
    c.is_ascii_alphanumeric() || c == '_'
}

/// Whether a text is a valid name.
#[must_use]
pub fn is_whole_name(text: &str) -> bool {
    let begins_well = text.chars().next().is_some_and(|c| !c.is_ascii_digit());
    begins_well && text.chars().all(is_name)
}

fn unit(text: &str, at: usize) -> Result<(TokenKind, usize), Fault> {
    match text[at..].find(']') {
        Some(end) => Ok((TokenKind::Unit, end + 1)),
        None => {
            let what = "the unit has no closing bracket";
            Err(Fault::at(text, at, what, "write it like 3[mm/s]"))
        }
    }
}

fn number(text: &str, at: usize) -> Result<(TokenKind, usize), Fault> {
    let rest = &text[at..];
    let length = number_length(rest.as_bytes());
    let runs_on = rest[length..]
        .chars()
        .next()
        .is_some_and(|c| is_name(c) || c == '.');
    let value = rest[..length]
        .parse::<f64>()
        .ok()
        .filter(|value| value.is_finite());
    match value {
        Some(value) if !runs_on => Ok((TokenKind::Number(value), length)),
        _ => {
            let end = rest.find(|c| !is_name(c) && c != '.').unwrap_or(rest.len());
            let what = format!("{} is not a number", shown(&rest[..end]));
            let hint = "write it like 0.5 or 2e-3, a unit like 3[mm/s], a product like 2 * x";
            Err(Fault::at(text, at, what, hint))
        }
    }
}

/// Length of the number literal at the beginning of a text: digits, point and exponent.
fn number_length(bytes: &[u8]) -> usize {
    let digits = |from: usize| {
        from + bytes[from..]
            .iter()
            .take_while(|b| b.is_ascii_digit())
            .count()
    };
    let mut end = digits(0);
    if bytes.get(end) == Some(&b'.') {
        end = digits(end + 1);
    }
    if let Some(b'e' | b'E') = bytes.get(end) {
        let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        let from = (end + 1 + sign).min(bytes.len());
        if digits(from) > from {
            end = digits(from);
        }
    }
    end
}

fn stray(text: &str, at: usize, c: char) -> Fault {
    let what = format!(
        "{} does not belong in a formula",
        shown(&c.escape_debug().to_string())
    );
    let hint = match c {
        '<' | '>' | '=' | '!' | '&' | '|' | '?' => {
            "comparisons are not supported: write step(a - b) for 1 where a > b"
        }
        '×' | '·' => "a product is written with *",
        '−' | '–' => "minus is written -",
        '²' | '³' => "a power is written x^2",
        ';' => "arguments are parted by commas",
        _ => "it holds numbers, names, + - * / ^, parentheses, commas and units such as 3[mm/s]",
    };
    Fault::at(text, at, what, hint)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cuts_where_things_end() {
        let found: Vec<TokenKind> = tokens("-2e-3[mm/s]*x1+.5")
            .unwrap()
            .iter()
            .map(|t| t.kind)
            .collect();
        use TokenKind::{End, Name, Number, Sign, Unit};
        let expected = [
            Sign('-'),
            Number(2e-3),
            Unit,
            Sign('*'),
            Name,
            Sign('+'),
            Number(0.5),
            End,
        ];
        assert_eq!(found, expected);
    }

    #[test]
    fn a_number_ends_before_a_letter_that_is_no_exponent() {
        for text in ["2x", "2e", "1.2.3", "1e999", ".", "3e+", "0x10"] {
            let fault = tokens(text).unwrap_err();
            assert_eq!(
                fault.what,
                format!("`{text}` is not a number").replace("`3e+`", "`3e`")
            );
        }
    }
}
