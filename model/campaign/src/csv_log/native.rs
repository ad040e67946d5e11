//! The project's log format: a header whose names include their unit, then one row per sample.

use std::sync::Arc;

use csv::StringRecord;
use hitch_input::input_error::quote;
use hitch_input::naming::{offer_names, unknown_name};
use hitch_input::source_file::SourceFile;
use hitch_plant::Linkage;

use crate::cell_error::cell_error;
use crate::columns::ColumnSettings;
use crate::csv_log::layout::Layout;
use crate::csv_log::mapped;
use crate::csv_log::text_rows::{Header, MARKS, rows};
use crate::recorded::CampaignError;
use crate::run_columns::{COLUMNS, Column, column};
use crate::table::Table;

/// Reads the table. The format is defined: nothing is assumed about its shape, its units or its numbers.
///
/// # Errors
/// The first fault, with line and column.
pub fn read(source: &Arc<SourceFile>, linkage: &Linkage) -> Result<Table, CampaignError> {
    let mark = mark(source);
    let Some((byte, record)) = rows(&source.text, 0, mark).next() else {
        let hint = "a log has a header, and one row for each sample";
        return Err(source.error("is empty", hint));
    };
    let columns = columns(source, &record, mark, byte)?;
    let mut header = Header::at(&source.text, mark, byte, &record);
    for (cell, column) in header.cells.iter_mut().zip(columns) {
        cell.unit = Some(column.unit.to_owned());
    }
    let layout = Layout::new(source, header);
    if let Some(assumed) = layout.notes.first() {
        let hint =
            "the project's format has one cell for each name, and no separators of thousands";
        return Err(source.error_at(byte, assumed.as_str(), hint));
    }
    mapped::read(source, &layout, &ColumnSettings::by_own_names(), linkage)
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

/// The columns that a header names.
///
/// # Errors
/// A name is not known, or occurs twice.
fn columns(
    source: &SourceFile,
    header: &StringRecord,
    mark: u8,
    byte: usize,
) -> Result<Vec<&'static Column>, CampaignError> {
    let mut columns: Vec<&'static Column> = Vec::with_capacity(header.len());
    for (index, given) in header.iter().enumerate() {
        let at = (index, mark.into());
        let Some(column) = column(given) else {
            let (what, hint) = unknown_column(given, index);
            return Err(cell_error(source, byte, at, what, hint));
        };
        if columns.contains(&column) {
            let what = format!("column {given} is duplicated");
            return Err(cell_error(source, byte, at, what, "delete one of the two"));
        }
        columns.push(column);
    }
    Ok(columns)
}

fn unknown_column(given: &str, index: usize) -> (String, String) {
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
    let known: Vec<&str> = COLUMNS.iter().map(|column| column.name).collect();
    let offered = offer_names(given, &known);
    (
        unknown_name("column", given, &known),
        format!("{offered}; or assign the columns under [columns], as `hitch import` does"),
    )
}
