//! Columns of numbers from a text table of any dialect, with the units in its header.

use hitch_input::input_error::{InputError, quote};
use hitch_input::source_file::SourceFile;

use crate::csv_log::dialect::{Header, HeaderCell};
use crate::csv_log::layout::Layout;

/// A column that a table has to have.
pub struct Wanted {
    /// Its quantity, for messages.
    pub quantity: &'static str,
    /// Words in its name; none if the unit identifies it.
    pub words: &'static [&'static str],
    /// Its units in lower case, with their size in SI.
    pub units: &'static [(&'static str, f64)],
    /// The units, for messages.
    pub offered: &'static str,
    /// Example of a header.
    pub example: &'static str,
}

/// Columns of numbers, in SI.
#[derive(Debug)]
pub struct NumberTable<const N: usize> {
    /// The columns, in the order asked for.
    pub columns: [Vec<f64>; N],
    /// Position of each row in the text.
    pub bytes: Vec<usize>,
}

impl<const N: usize> NumberTable<N> {
    /// Reads the columns; rows that are empty or begin with `#` are skipped.
    ///
    /// # Errors
    /// A fault in the table, by line.
    pub fn read(source: &SourceFile, wanted: &[Wanted; N]) -> Result<Self, InputError> {
        let header = Header::guessed(&source.text).ok_or_else(|| {
            let example = wanted[0].example;
            let mend = format!(
                "write a header such as {example} above the numbers, and one row for each point"
            );
            source.error("is not a table with a header", mend)
        })?;
        let mut found = [(0, 1.0); N];
        for (found, wanted) in found.iter_mut().zip(wanted) {
            *found = column(source, &header, wanted)?;
        }
        let layout = Layout::new(source, header);
        let mut table = Self {
            columns: [const { Vec::new() }; N],
            bytes: Vec::new(),
        };
        layout.each_row(|row| {
            if row.is_remark() {
                return Ok(None);
            }
            for (values, (column, unit)) in table.columns.iter_mut().zip(found) {
                let text = row.cell(column);
                let number = layout.decimals[column].number(text).ok_or_else(|| {
                    let what = format!("{} is not a number", quote(text));
                    source.error_at(row.byte, what, "write a number, or delete the row")
                })?;
                values.push(unit * number);
            }
            table.bytes.push(row.byte);
            Ok(None)
        })?;
        Ok(table)
    }
}

/// Index and unit of a column.
fn column(
    source: &SourceFile,
    header: &Header,
    wanted: &Wanted,
) -> Result<(usize, f64), InputError> {
    let is_named = |cell: &HeaderCell| {
        let name = cell.name.to_lowercase();
        wanted.words.is_empty() || wanted.words.iter().any(|word| name.contains(word))
    };
    let cells = header.cells.iter().enumerate();
    let mut found = cells
        .filter(|(_, cell)| is_named(cell))
        .filter_map(|(index, cell)| Some((index, unit(cell, wanted.units)?)));
    found.next().ok_or_else(|| {
        let what = format!("no column is a {} in {}", wanted.quantity, wanted.offered);
        let mend = format!("write the unit in the header, as in {}", wanted.example);
        source.error_at(header.byte, what, mend)
    })
}

/// Size of a column's unit in SI; `None` for unknown units.
fn unit(cell: &HeaderCell, units: &[(&str, f64)]) -> Option<f64> {
    let written = cell.unit.as_ref().map(|unit| unit.to_lowercase());
    let name = cell.name.to_lowercase();
    let is_of = |unit: &str| match &written {
        Some(written) => written == unit,
        None => name.ends_with(&format!("_{unit}")),
    };
    units
        .iter()
        .find(|(unit, _)| is_of(unit))
        .map(|(_, si)| *si)
}
