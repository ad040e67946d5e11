//! The rows of a text table, and its header.

use csv::StringRecord;

/// Possible separators, by priority: the comma may be a decimal mark, and spaces, of which several are one, are within names.
pub const MARKS: [u8; 5] = [b'\t', b';', b'|', b',', b' '];

/// A cell of a header.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct HeaderCell {
    /// Its full text.
    pub text: String,
    /// Its text without a unit in brackets.
    pub name: String,
    /// Its unit, from brackets or from a row of units below.
    pub unit: Option<String>,
}

/// The header of a table.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Header {
    /// Separator.
    pub mark: u8,
    /// Its byte offset in the text.
    pub byte: usize,
    /// Its cells.
    pub cells: Vec<HeaderCell>,
    /// Number of its cells, with those behind the last name.
    pub width: usize,
    /// Byte offset of the first sample.
    pub data_byte: usize,
}

/// The rows of a text from `byte` on, each with its byte offset in the text.
pub fn rows(text: &str, byte: usize, mark: u8) -> impl Iterator<Item = (usize, StringRecord)> {
    let rest = text.get(byte..).unwrap_or_default();
    let reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .delimiter(mark)
        .trim(csv::Trim::All)
        .from_reader(rest.as_bytes());
    // The text is valid UTF-8 in memory: reading cannot fail.
    reader.into_records().map_while(Result::ok).map(move |row| {
        let start = row
            .position()
            .map_or(0, |position| position.byte() as usize);
        let row = match mark {
            b' ' => row.iter().filter(|cell| !cell.is_empty()).collect(),
            _ => row,
        };
        (row_start(text, byte + start), row)
    })
}

/// The reader counts the line breaks before a row as part of it; an editor does not.
fn row_start(text: &str, byte: usize) -> usize {
    let rest = &text.as_bytes()[byte.min(text.len())..];
    let breaks = rest.iter().take_while(|b| matches!(b, b'\n' | b'\r'));
    byte + breaks.count()
}
