//! Text tables: the project's own format, whose header has the columns' names, and any other by `[columns]`.
pub mod clock;
pub mod dialect;
mod layout;
mod lvm;
mod mapped;
mod native;
pub mod number_table;

use std::sync::Arc;

use dialect::{Header, HeaderCell};
use hitch_input::source_file::SourceFile;
use hitch_plant::Linkage;
use layout::Layout;

use crate::CampaignError;
use crate::columns::{ColumnSettings, offer_columns};
use crate::scale::spelling;
use crate::survey::{LogColumn, Survey};
use crate::table::Table;

/// Reads a table for a hitch with this linkage; `settings` map its columns unless it has the project's own header.
///
/// # Errors
/// The first fault, with line and column.
pub fn read(
    source: &Arc<SourceFile>,
    settings: Option<&ColumnSettings>,
    linkage: &Linkage,
) -> Result<Table, CampaignError> {
    let Some(settings) = settings else {
        return native::read(source, linkage);
    };
    let names: Vec<&str> = settings
        .sources
        .iter()
        .map(|wanted| wanted.name.as_str())
        .collect();
    match Header::with_names(&source.text, &names) {
        Some(header) => mapped::read(source, &Layout::new(source, header), settings, linkage),
        None if native::has_own_header(source) => native::read(source, linkage),
        None => Err(no_header(source, &names)),
    }
}

fn no_header(source: &SourceFile, wanted: &[&str]) -> CampaignError {
    let what = "no row contains any of the names under [columns]";
    match Header::guessed(&source.text) {
        Some(header) => {
            let first = wanted.first().copied().unwrap_or_default();
            source.error_at(header.byte, what, offer_columns(first, &header.names()))
        }
        None => source.error(what, "a log has a header, and one row for each sample"),
    }
}

/// The columns of a table, with the numbers of at most this many rows.
///
/// # Errors
/// The text is not a table.
pub fn survey(source: &SourceFile) -> Result<Survey, CampaignError> {
    const MOST_ROWS: usize = 200_000;
    if native::has_own_header(source) {
        return Ok(Survey::Own);
    }
    let Some(header) = Header::guessed(&source.text) else {
        let what = "is not a table: there is no header above the rows of numbers";
        let mend = "export it with a header, and commas, semicolons or tabs between the columns";
        return Err(source.error(what, mend));
    };
    let layout = Layout::new(source, header);
    let mut columns: Vec<LogColumn> = layout.header.cells.iter().map(empty_column).collect();
    let mut rows = 0;
    let below = layout.each_row(|row| {
        rows += 1;
        for (index, column) in columns.iter_mut().enumerate().filter(|_| rows <= MOST_ROWS) {
            let cell = row.cell(index);
            let number = layout.decimals[index].number(cell);
            let number = number.filter(|number| number.is_finite());
            column.is_clock |= column.values.is_empty() && clock::is_clock(cell);
            column.values.push(number.unwrap_or(f64::NAN));
        }
        Ok(None)
    })?;
    let mut notes = layout.notes.clone();
    match below.lines {
        0 => {}
        1 => notes.push("a line below the samples is left out".to_owned()),
        lines => notes.push(format!("{lines} lines below the samples are left out")),
    }
    for (index, base) in layout.bases.iter().enumerate() {
        columns[index].times = base.map(|base| layout.header.cells[base].name.clone());
    }
    columns.retain(|column| !column.name.is_empty());
    Ok(Survey::Table { columns, notes })
}

fn empty_column(cell: &HeaderCell) -> LogColumn {
    LogColumn {
        name: cell.name.clone(),
        unit: cell.unit.as_deref().map(|unit| spelling(unit).to_owned()),
        ..LogColumn::default()
    }
}
