//! Text tables: the project's own format, whose header has the columns' names, and any other by `[columns]`.
pub mod clock;
pub mod decimals;
pub mod dialect;
mod layout;
mod lvm;
mod mapped;
mod native;
pub mod text_rows;

use std::sync::Arc;

use hitch_input::input_error::{InputError, quote};
use hitch_input::source_file::SourceFile;
use hitch_plant::Linkage;
use layout::Layout;
use text_rows::Header;

use crate::cell_error::cell_error;
use crate::columns::{ColumnSettings, offer_columns};
use crate::contents::{LogColumn, Survey};
use crate::recorded::CampaignError;
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

/// The columns of a table.
///
/// # Errors
/// The text is not a table.
pub fn survey(source: &SourceFile) -> Result<Survey, CampaignError> {
    if native::has_own_header(source) {
        return Ok(Survey::Own);
    }
    let table = text_table(source)?.ok_or_else(|| {
        let what = "is not a table: there is no header above the rows of numbers";
        let hint = "export it with a header, and commas, semicolons or tabs between the columns";
        source.error(what, hint)
    })?;
    let TextTable { columns, notes, .. } = table;
    Ok(Survey::Table { columns, notes })
}

/// A text table of any dialect.
#[derive(Debug, Clone, PartialEq)]
pub struct TextTable {
    /// Its columns with a name.
    pub columns: Vec<LogColumn>,
    /// Byte offset of the header in the text.
    pub header: usize,
    /// Byte offset of each row in the text.
    pub rows: Vec<usize>,
    /// Separator of the cells.
    mark: char,
    /// What was assumed about its shape and times, one line each.
    pub notes: Vec<String>,
}

impl TextTable {
    /// The numbers of a column, as logged.
    ///
    /// # Errors
    /// A cell is not a number.
    pub fn numbers<'t>(
        &self,
        source: &SourceFile,
        column: &'t LogColumn,
    ) -> Result<&'t [f64], InputError> {
        let Some(row) = column.values.iter().position(|value| value.is_nan()) else {
            return Ok(&column.values);
        };
        let what = format!("the cell of {} is not a number", quote(&column.name));
        let hint = "write a number, or delete the row";
        Err(self.fault(source, row, column, what, hint))
    }

    /// A fault of the cell of a column.
    pub fn fault(
        &self,
        source: &SourceFile,
        row: usize,
        column: &LogColumn,
        what: String,
        hint: impl Into<String>,
    ) -> InputError {
        cell_error(source, self.rows[row], (column.cell, self.mark), what, hint)
    }
}

/// Reads the columns of a table, with the numbers of at most this many rows; `None` if the text is not a table. Rows
/// that are empty or begin with `#` are skipped.
///
/// # Errors
/// A row does not have the cells of the header.
pub fn text_table(source: &SourceFile) -> Result<Option<TextTable>, CampaignError> {
    const MOST_ROWS: usize = 200_000;
    let Some(header) = Header::guessed(&source.text) else {
        return Ok(None);
    };
    let layout = Layout::new(source, header);
    let cells = layout.header.cells.iter();
    let mut columns: Vec<LogColumn> = cells
        .map(|cell| LogColumn::new(&cell.name, cell.unit.as_deref()))
        .collect();
    let mut rows = Vec::new();
    let below = layout.each_row(|row| {
        if rows.len() == MOST_ROWS || row.is_remark() {
            return Ok(None);
        }
        rows.push(row.byte);
        for (index, column) in columns.iter_mut().enumerate() {
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
        columns[index].cell = layout.cell(index);
        columns[index].times = base.map(|base| layout.header.cells[base].name.clone());
    }
    columns.retain(|column| !column.name.is_empty());
    let header = layout.header.byte;
    Ok(Some(TextTable {
        columns,
        header,
        rows,
        mark: layout.header.mark.into(),
        notes,
    }))
}
