//! Reads TOML tables key by key, with line and column for every fault.

use std::ops::{Range, RangeInclusive};

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::input_error::{InputError, quote};
use crate::naming::{offer_names, unknown_name};
use crate::source_file::SourceFile;

/// One table of a TOML file.
#[derive(Debug, Clone)]
pub struct TomlTable<'a> {
    source: &'a SourceFile,
    name: String,
    span: Range<usize>,
    entries: DeTable<'a>,
}

impl<'a> TomlTable<'a> {
    /// Parses a file; returns its top-level table.
    ///
    /// # Errors
    /// The text is not TOML.
    pub fn parse(source: &'a SourceFile) -> Result<Self, InputError> {
        let entries = DeTable::parse(&source.text).map_err(|error| {
            let byte = error.span().map_or(0, |span| span.start);
            let what = format!("is not TOML: {}", error.message());
            source.error_at(byte, what, mend_of(error.message()))
        })?;
        let name = "the top level".to_owned();
        Ok(Self {
            source,
            name,
            span: entries.span(),
            entries: entries.into_inner(),
        })
    }

    /// A fault of this table.
    pub fn error(&self, what: impl Into<String>, hint: impl Into<String>) -> InputError {
        self.source.error_at(self.span.start, what, hint)
    }

    /// A fault of the value of `key`, or of the table without such a key.
    pub fn error_at(
        &self,
        key: &str,
        what: impl Into<String>,
        hint: impl Into<String>,
    ) -> InputError {
        let byte = self
            .entries
            .get(key)
            .map_or(self.span.start, |value| value.span().start);
        self.source.error_at(byte, what, hint)
    }

    /// A fault at a byte of the text of `key`; at its beginning if the text contains escapes.
    pub fn error_inside(
        &self,
        key: &str,
        byte: usize,
        what: impl Into<String>,
        hint: impl Into<String>,
    ) -> InputError {
        let inside = || {
            let value = self.entries.get(key)?;
            let DeValue::String(text) = value.get_ref() else {
                return None;
            };
            let written = self.source.text.get(value.span())?;
            // One quote or three; without escapes the text between them is literal.
            Some(value.span().start + written.find(text.as_ref())?.max(1) + byte)
        };
        match inside() {
            Some(byte) => self.source.error_at(byte, what, hint),
            None => self.error_at(key, what, hint),
        }
    }

    /// The file of this table.
    pub fn source(&self) -> &'a SourceFile {
        self.source
    }

    /// Whether the table has this key.
    pub fn has(&self, key: &str) -> bool {
        self.entries.contains_key(key)
    }

    /// Whether the value of this key is a table.
    pub fn is_table(&self, key: &str) -> bool {
        let value = self.entries.get(key).map(Spanned::get_ref);
        matches!(value, Some(DeValue::Table(_)))
    }

    /// The keys of the table, in alphabetical order.
    pub fn keys(&self) -> impl Iterator<Item = &str> {
        self.entries.keys().map(|key| key.get_ref().as_ref())
    }

    /// Rejects keys that are not in `known`.
    ///
    /// # Errors
    /// The first such key of the file.
    pub fn only(&self, known: &[&str]) -> Result<(), InputError> {
        let unknown = self
            .entries
            .keys()
            .filter(|key| !known.contains(&key.get_ref().as_ref()));
        match unknown.min_by_key(|key| key.span().start) {
            None => Ok(()),
            Some(key) => {
                let what = format!(
                    "{} in {}",
                    unknown_name("key", key.get_ref(), known),
                    self.name
                );
                Err(self
                    .source
                    .error_at(key.span().start, what, offer_names(key.get_ref(), known)))
            }
        }
    }

    /// A number within a range; `None` if the key is missing.
    ///
    /// # Errors
    /// The value is not a finite number in the range.
    pub fn number(&self, key: &str, range: RangeInclusive<f64>) -> Result<Option<f64>, InputError> {
        let Some(value) = self.entries.get(key) else {
            return Ok(None);
        };
        let Some(number) = as_number(value.get_ref()) else {
            let what = format!("{key} has to be a number, not {}", kind(value.get_ref()));
            return Err(self.error_at(
                key,
                what,
                format!("write for example {key} = {}", example(&range)),
            ));
        };
        if range.contains(&number) {
            return Ok(Some(number));
        }
        let what = format!("{key} = {number} is out of range");
        let hint = format!("the range is {} to {}", range.start(), range.end());
        Err(self.error_at(key, what, hint))
    }

    /// Checks the format version of the file, which is 1.
    ///
    /// # Errors
    /// It is missing or not supported.
    pub fn check_format(&self) -> Result<(), InputError> {
        let format = self.required_number("format", f64::MIN..=f64::MAX)?;
        if format == 1.0 {
            return Ok(());
        }
        let what = format!("format {format} is not known");
        Err(self.error_at("format", what, "this program reads format = 1"))
    }

    /// A required number.
    ///
    /// # Errors
    /// The key is missing, or its value is not a finite number in the range.
    pub fn required_number(
        &self,
        key: &str,
        range: RangeInclusive<f64>,
    ) -> Result<f64, InputError> {
        self.number(key, range)?.ok_or_else(|| self.missing(key))
    }

    /// A list of numbers within a range; `None` if the key is missing.
    ///
    /// # Errors
    /// The value is not a list, or one of its elements is not a finite number in the range.
    pub fn numbers(
        &self,
        key: &str,
        range: RangeInclusive<f64>,
    ) -> Result<Option<Vec<f64>>, InputError> {
        let Some(value) = self.entries.get(key) else {
            return Ok(None);
        };
        let DeValue::Array(items) = value.get_ref() else {
            let what = format!(
                "{key} has to be a list of numbers, not {}",
                kind(value.get_ref())
            );
            return Err(self.error_at(
                key,
                what,
                format!("write for example {key} = [{}]", example(&range)),
            ));
        };
        let number = |item: &Spanned<DeValue<'_>>| {
            as_number(item.get_ref())
                .filter(|number| range.contains(number))
                .ok_or_else(|| {
                    let what =
                        format!("{key} contains a value that is not a number within its range");
                    let hint = format!("the range is {} to {}", range.start(), range.end());
                    self.source.error_at(item.span().start, what, hint)
                })
        };
        items.iter().map(number).collect::<Result<_, _>>().map(Some)
    }

    /// A text; `None` if the key is missing.
    ///
    /// # Errors
    /// The value is not a text.
    pub fn text(&self, key: &str) -> Result<Option<&str>, InputError> {
        match self.entries.get(key).map(Spanned::get_ref) {
            None => Ok(None),
            Some(DeValue::String(text)) => Ok(Some(text)),
            Some(other) => {
                let what = format!("{key} has to be a text, not {}", kind(other));
                Err(self.error_at(key, what, format!("write {key} = \"...\"")))
            }
        }
    }

    /// A list of texts; `None` if the key is missing.
    ///
    /// # Errors
    /// The value is not a list of texts.
    pub fn texts(&self, key: &str) -> Result<Option<Vec<&str>>, InputError> {
        let Some(value) = self.entries.get(key) else {
            return Ok(None);
        };
        let text = |item: &'_ Spanned<DeValue<'a>>| matches!(item.get_ref(), DeValue::String(_));
        match value.get_ref() {
            DeValue::Array(items) if items.iter().all(text) => {
                let texts = items.iter().filter_map(|item| item.get_ref().as_str());
                Ok(Some(texts.collect()))
            }
            _ => {
                let what = format!("{key} has to be a list of texts");
                Err(self.error_at(key, what, format!("write {key} = [\"...\"]")))
            }
        }
    }

    /// A required text.
    ///
    /// # Errors
    /// The key is missing or its value is not a text.
    pub fn required_text(&self, key: &str) -> Result<&str, InputError> {
        self.text(key)?.ok_or_else(|| self.missing(key))
    }

    /// The table `[key]`; `None` if it is missing.
    ///
    /// # Errors
    /// The value is not a table.
    pub fn table(&self, key: &str) -> Result<Option<TomlTable<'a>>, InputError> {
        let Some(value) = self.entries.get(key) else {
            return Ok(None);
        };
        let DeValue::Table(entries) = value.get_ref() else {
            let what = format!("{key} has to be a table, not {}", kind(value.get_ref()));
            return Err(self.error_at(
                key,
                what,
                format!("write a line [{}] and its keys below it", self.path(key)),
            ));
        };
        let name = format!("[{}]", self.path(key));
        Ok(Some(self.inner(name, value.span(), entries)))
    }

    /// The tables `[[key]]`, in the order of the file; empty if there are none.
    ///
    /// # Errors
    /// The value is not a list of tables.
    pub fn tables(&self, key: &str) -> Result<Vec<TomlTable<'a>>, InputError> {
        let Some(value) = self.entries.get(key) else {
            return Ok(Vec::new());
        };
        let name = format!("[[{}]]", self.path(key));
        let hint = format!("write a line {name} and its keys below it");
        let DeValue::Array(items) = value.get_ref() else {
            let what = format!(
                "{key} has to be a list of tables, not {}",
                kind(value.get_ref())
            );
            return Err(self.error_at(key, what, hint));
        };
        let table = |item: &Spanned<DeValue<'a>>| match item.get_ref() {
            DeValue::Table(entries) => Ok(self.inner(name.clone(), item.span(), entries)),
            other => {
                let what = format!(
                    "{key} has to be a list of tables, but contains {}",
                    kind(other)
                );
                Err(self.source.error_at(item.span().start, what, hint.clone()))
            }
        };
        items.iter().map(table).collect()
    }

    /// The fault of a missing key.
    pub fn missing(&self, key: &str) -> InputError {
        self.error(
            format!("{} has no {key}", self.name),
            format!("add a line {key} = ..."),
        )
    }

    /// The path of a key of this table, as in a heading.
    fn path(&self, key: &str) -> String {
        let own = self.name.trim_matches(['[', ']']);
        if own == self.name {
            key.to_owned()
        } else {
            format!("{own}.{key}")
        }
    }

    fn inner(&self, name: String, span: Range<usize>, entries: &DeTable<'a>) -> TomlTable<'a> {
        TomlTable {
            source: self.source,
            name,
            span,
            entries: entries.clone(),
        }
    }
}

/// Suggested correction for an error of the TOML parser.
fn mend_of(message: &str) -> &'static str {
    if message.contains("duplicate key") {
        "delete one of the two, or give it another name"
    } else if message.contains("recurs") {
        "remove brackets and dots; the deepest allowed nesting is a list in a table"
    } else if message.contains("carriage return") {
        "save it with Unix (LF) or Windows (CR LF) line ends"
    } else {
        "write it as key = value"
    }
}

/// An example number in a range.
fn example(range: &RangeInclusive<f64>) -> f64 {
    /// Beyond this an end of the range is not a sensible example.
    const LARGE: f64 = 1e5;
    match *range.start() {
        start if start.abs() <= LARGE => start,
        _ if range.contains(&1.0) => 1.0,
        start => start,
    }
}

fn as_number(value: &DeValue<'_>) -> Option<f64> {
    let number: f64 = match value {
        DeValue::Float(float) => float.as_str().parse().ok()?,
        DeValue::Integer(integer) => {
            i64::from_str_radix(integer.as_str(), integer.radix()).ok()? as f64
        }
        _ => return None,
    };
    number.is_finite().then_some(number)
}

fn kind(value: &DeValue<'_>) -> String {
    match value {
        DeValue::String(text) => format!("the text {}", quote(text)),
        DeValue::Integer(number) => quote(number.as_str()),
        DeValue::Float(number) => quote(number.as_str()),
        DeValue::Boolean(value) => value.to_string(),
        DeValue::Datetime(_) => "a date".to_owned(),
        DeValue::Array(_) => "a list".to_owned(),
        DeValue::Table(_) => "a table".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn source(text: &str) -> SourceFile {
        SourceFile {
            path: "m.toml".into(),
            text: text.to_owned(),
        }
    }

    fn fault(text: &str, check: impl Fn(&TomlTable<'_>) -> Result<(), InputError>) -> String {
        let source = source(text);
        match TomlTable::parse(&source).and_then(|table| check(&table)) {
            Ok(()) => "no fault".to_owned(),
            Err(error) => error.to_string(),
        }
    }

    #[test]
    fn faults_have_a_place() {
        let unknown = fault("relief_psi = 1\n", |table| table.only(&["relief_bar"]));
        assert!(
            unknown.starts_with("m.toml:1:1: unit psi is not known, this key has to be relief_bar"),
            "{unknown}"
        );
        let range = fault("\na = 7\n", |table| table.number("a", 0.0..=5.0).map(drop));
        assert!(
            range.starts_with("m.toml:2:5: a = 7 is out of range"),
            "{range}"
        );
        let syntax = fault("a = 1\nb = = 2\n", |_| Ok(()));
        assert!(syntax.starts_with("m.toml:2:"), "{syntax}");
        let list = fault("a = [1, 'x']", |table| {
            table.numbers("a", 0.0..=5.0).map(drop)
        });
        assert!(list.starts_with("m.toml:1:9:"), "{list}");
    }

    #[test]
    fn mends_are_what_somebody_would_do() {
        let hint = |text: &str| {
            fault(text, |table| {
                table.number("a", f64::MIN..=f64::MAX).map(drop)
            })
        };
        for (text, expected) in [
            ("a = \"1\"", "write for example a = 1"),
            ("a = nan", "write for example a = 1"),
            ("a = 1\na = 2", "delete one of the two"),
            ("a = 1\rb = 2", "save it with Unix (LF)"),
            ("a = = 1", "write it as key = value"),
        ] {
            let said = hint(text);
            assert!(said.contains(expected) && said.len() < 200, "{said}");
        }
        for deep in [
            format!("a = {}", "[".repeat(5_000)),
            format!("[{}]", ["a"; 5_000].join(".")),
        ] {
            assert!(
                hint(&deep).contains("remove brackets and dots"),
                "{}",
                hint(&deep)
            );
        }
    }

    #[test]
    fn numbers_may_be_written_as_integers_but_not_as_nan() {
        let text = source("a = 4\nb = 4.5\nc = nan\nd = 1e999\ne = 0x10\nf = 99999999999999999999");
        let table = TomlTable::parse(&text).unwrap();
        let everything = f64::MIN..=f64::MAX;
        assert_eq!(table.number("a", everything.clone()).unwrap(), Some(4.0));
        assert_eq!(table.number("b", everything.clone()).unwrap(), Some(4.5));
        assert_eq!(table.number("e", everything.clone()).unwrap(), Some(16.0));
        assert_eq!(table.number("z", everything.clone()).unwrap(), None);
        for key in ["c", "d", "f"] {
            assert!(table.number(key, everything.clone()).is_err(), "{key}");
        }
    }
}
