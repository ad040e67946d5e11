//! The project's log format: a header whose names include their unit, then one row per sample.

use std::sync::Arc;

use csv::StringRecord;
use hitch_input::input_error::quote;
use hitch_input::naming::{offer_names, unknown_name};
use hitch_input::source_file::SourceFile;

use crate::CampaignError;
use crate::csv_log::dialect::{Decimals, MARKS, rows};
use crate::table::{COLUMNS, Cells, Samples, TIME, Table, cell_error, column};

/// Reads the table.
///
/// # Errors
/// The first fault, with line and column.
pub fn read(source: &Arc<SourceFile>) -> Result<Table, CampaignError> {
    let mark = mark(source);
    let mut records = rows(&source.text, 0, mark);
    let Some((byte, header)) = records.next() else {
        return Err(source.error(
            "is empty",
            "a log has a header, and one row for each sample",
        ));
    };
    let names = column_names(source, &header, mark, byte)?;
    let mut rows = Rows {
        source,
        mark,
        decimals: decimals(source, mark, names.len()),
        columns: names.iter().map(|name| (*name, Vec::new())).collect(),
        bytes: Vec::new(),
    };
    for (byte, record) in records {
        rows.push(&record, byte)?;
    }
    if rows.bytes.is_empty() {
        return Err(source.error("contains a header but no samples", "log the run again"));
    }
    let columns = rows.columns.into_iter().enumerate();
    let columns = columns.map(|(cell, (name, values))| Samples { name, cell, values });
    let cells = Cells::Between(mark.into());
    Table::new(Arc::clone(source), columns.collect(), rows.bytes, cells)
}

/// Whether all columns have the project's names.
pub fn has_own_header(source: &SourceFile) -> bool {
    let header = rows(&source.text, 0, mark(source)).next();
    header.is_some_and(|(_, header)| header.iter().all(|name| column(name).is_some()))
}

/// The separator that yields the most known names in the header; a comma if none does.
fn mark(source: &SourceFile) -> u8 {
    let known = |mark: &u8| {
        let header = rows(&source.text, 0, *mark).next();
        header.map_or(0, |(_, header)| {
            header.iter().filter(|name| column(name).is_some()).count()
        })
    };
    // Of several equal ones the last is chosen.
    let marks = MARKS.into_iter().filter(|mark| *mark != b' ');
    marks.max_by_key(known).unwrap_or(b',')
}

/// The decimal mark: never a comma if commas are separators.
fn decimals(source: &SourceFile, mark: u8, width: usize) -> Option<Decimals> {
    const EXAMINED_ROWS: usize = 1_000;
    (mark != b',').then(|| {
        let first: Vec<StringRecord> = rows(&source.text, 0, mark)
            .skip(1)
            .take(EXAMINED_ROWS)
            .map(|(_, row)| row)
            .collect();
        Decimals::of(first.iter().flat_map(|row| row.iter().take(width)))
    })
}

/// The rows read so far.
struct Rows<'a> {
    source: &'a SourceFile,
    mark: u8,
    decimals: Option<Decimals>,
    columns: Vec<(&'static str, Vec<f64>)>,
    /// Byte offset of each row in the file.
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
            let value = number(name, cell, self.decimals).map_err(|(what, mend)| {
                cell_error(self.source, byte, (index, self.mark.into()), what, mend)
            })?;
            self.columns[index].1.push(value);
        }
        Ok(())
    }
}

/// Checks the header and returns the column names.
fn column_names(
    source: &SourceFile,
    header: &StringRecord,
    mark: u8,
    byte: usize,
) -> Result<Vec<&'static str>, CampaignError> {
    let known: Vec<&'static str> = COLUMNS.iter().map(|column| column.name).collect();
    let mut names: Vec<&'static str> = Vec::with_capacity(header.len());
    for (index, given) in header.iter().enumerate() {
        let Some(name) = known.iter().find(|name| **name == given) else {
            let (what, mend) = unknown_column(given, index, &known);
            return Err(cell_error(source, byte, (index, mark.into()), what, mend));
        };
        if names.contains(name) {
            let what = format!("column {name} is duplicated");
            return Err(cell_error(
                source,
                byte,
                (index, mark.into()),
                what,
                "delete one of the two",
            ));
        }
        names.push(name);
    }
    Ok(names)
}

fn unknown_column(given: &str, index: usize, known: &[&str]) -> (String, String) {
    if given.is_empty() {
        return (
            format!("column {} has no name", index + 1),
            "delete the column or name it".to_owned(),
        );
    }
    if given.parse::<f64>().is_ok() {
        return (
            format!("{} is not a column name", quote(given)),
            "start with a header".to_owned(),
        );
    }
    (
        unknown_name("column", given, known),
        format!(
            "{}; or assign the columns under [columns], as `hitch import` does",
            offer_names(given, known)
        ),
    )
}

/// The number in a cell; NaN for an empty cell, which is an error for time.
fn number(
    name: &'static str,
    cell: &str,
    decimals: Option<Decimals>,
) -> Result<f64, (String, String)> {
    if cell.is_empty() && name != TIME {
        return Ok(f64::NAN);
    }
    let mend = if name == TIME {
        "every row needs a time"
    } else {
        "leave the cell of a dropout empty"
    };
    let read = match decimals {
        Some(decimals) => decimals.number(cell),
        None => cell.parse::<f64>().ok(),
    };
    let value = match read {
        Some(value) => value,
        None => {
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
    let mend = format!("the range is {} to {}; {mend}", range.start(), range.end());
    Err((format!("{value} in column {name} is out of range"), mend))
}
