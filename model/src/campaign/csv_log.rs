//! A log as a table of numbers with commas: a header whose names carry their unit, then a row a sample.
use csv::StringRecord;

use super::CampaignError;
use super::table::{COLUMNS, Cells, TIME, Table, cell_error, column};
use crate::input_error::{InputError, quote};
use crate::naming::{offer_names, unknown_name};
use crate::source_file::SourceFile;

/// Reads the table.
///
/// # Errors
/// Whatever is wrong first, by line and column.
pub fn read(source: &SourceFile) -> Result<Table<'_>, CampaignError> {
    let mut reader = csv::ReaderBuilder::new()
        .flexible(true)
        .trim(csv::Trim::All)
        .from_reader(source.text.as_bytes());
    let header = reader
        .headers()
        .map_err(|error| not_csv(source, &error))?
        .clone();
    let names = column_names(source, &header, row_start(source, 0))?;
    let mut rows = Rows {
        source,
        columns: names.iter().map(|name| (*name, Vec::new())).collect(),
        bytes: Vec::new(),
    };
    let mut record = StringRecord::new();
    while reader
        .read_record(&mut record)
        .map_err(|error| not_csv(source, &error))?
    {
        let byte = record
            .position()
            .map_or(0, |position| position.byte() as usize);
        rows.push(&record, row_start(source, byte))?;
    }
    if rows.bytes.is_empty() {
        return Err(source.error("holds a header but no samples", "log the run again"));
    }
    Table::new(source, rows.columns, rows.bytes, Cells::Commas)
}

/// The rows that have been read.
struct Rows<'a> {
    source: &'a SourceFile,
    columns: Vec<(&'static str, Vec<f64>)>,
    /// First byte of each in the file.
    bytes: Vec<usize>,
}

impl Rows<'_> {
    fn push(&mut self, record: &StringRecord, byte: usize) -> Result<(), CampaignError> {
        if record.len() != self.columns.len() {
            let what = format!(
                "the row has {} cells, the header has {}",
                record.len(),
                self.columns.len()
            );
            return Err(self.source.error_at(
                byte,
                what,
                "leave the cell of a dropout empty, but keep its comma",
            ));
        }
        self.bytes.push(byte);
        for (index, cell) in record.iter().enumerate() {
            let name = self.columns[index].0;
            let value = number(name, cell)
                .map_err(|(what, mend)| cell_error(self.source, byte, index, what, mend))?;
            self.columns[index].1.push(value);
        }
        Ok(())
    }
}

/// Checks the header and gives each column its name.
fn column_names(
    source: &SourceFile,
    header: &StringRecord,
    byte: usize,
) -> Result<Vec<&'static str>, CampaignError> {
    if header.is_empty() {
        return Err(source.error("is empty", "a log has a header and a row a sample"));
    }
    let known: Vec<&'static str> = COLUMNS.iter().map(|column| column.name).collect();
    let mut names: Vec<&'static str> = Vec::with_capacity(header.len());
    for (index, given) in header.iter().enumerate() {
        let Some(name) = known.iter().find(|name| **name == given) else {
            let (what, mend) = unknown_column(given, index, header, &known);
            return Err(cell_error(source, byte, index, what, mend));
        };
        if names.contains(name) {
            let what = format!("column {name} is there twice");
            return Err(cell_error(
                source,
                byte,
                index,
                what,
                "delete one of the two",
            ));
        }
        names.push(name);
    }
    Ok(names)
}

fn unknown_column(
    given: &str,
    index: usize,
    header: &StringRecord,
    known: &[&str],
) -> (String, String) {
    if given.is_empty() {
        return (
            format!("column {} has no name", index + 1),
            "delete the column or name it".to_owned(),
        );
    }
    if header.len() == 1 && given.contains([';', '\t']) {
        return (
            "columns are not separated by commas".to_owned(),
            "write a,b,c with decimal points".to_owned(),
        );
    }
    if given.parse::<f64>().is_ok() {
        return (
            format!("{} stands where a column's name should", quote(given)),
            "begin with a header".to_owned(),
        );
    }
    (
        unknown_name("column", given, known),
        offer_names(given, known),
    )
}

/// The number in a cell; NaN if the cell is empty, which only time may not be.
fn number(name: &'static str, cell: &str) -> Result<f64, (String, String)> {
    if cell.is_empty() && name != TIME {
        return Ok(f64::NAN);
    }
    let mend = if name == TIME {
        "every row needs its time"
    } else {
        "leave the cell of a dropout empty"
    };
    let value: f64 = match cell.parse() {
        Ok(value) => value,
        Err(_) => {
            return Err((
                format!("{} in column {name} is not a number", quote(cell)),
                mend.to_owned(),
            ));
        }
    };
    let Some(range) = column(name).map(|column| &column.range) else {
        return Ok(value);
    };
    if range.contains(&value) {
        return Ok(value);
    }
    if !value.is_finite() {
        return Err((
            format!("{} in column {name} is not finite", quote(cell)),
            mend.to_owned(),
        ));
    }
    let mend = format!("it may be {} to {}; {mend}", range.start(), range.end());
    Err((format!("{value} in column {name} cannot be"), mend))
}

fn not_csv(source: &SourceFile, error: &csv::Error) -> InputError {
    let byte = error
        .position()
        .map_or(0, |position| position.byte() as usize);
    source.error_at(byte, format!("is not CSV: {error}"), "")
}

/// The reader counts the line breaks before a row as part of it; an editor does not.
fn row_start(source: &SourceFile, byte: usize) -> usize {
    let rest = &source.text.as_bytes()[byte.min(source.text.len())..];
    byte + rest
        .iter()
        .take_while(|b| matches!(b, b'\n' | b'\r'))
        .count()
}
