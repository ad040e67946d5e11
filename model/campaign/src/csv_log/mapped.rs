//! Reads any table, mapped by `[columns]`: its own names, units and times; other columns are ignored.

use std::sync::Arc;

use csv::StringRecord;
use hitch_input::input_error::quote;
use hitch_input::source_file::SourceFile;
use hitch_plant::Linkage;

use crate::CampaignError;
use crate::columns::{ColumnSettings, Source, offer_columns};
use crate::csv_log::clock::Times;
use crate::csv_log::dialect::{Decimals, Header, rows};
use crate::scale::{Scale, is_time};
use crate::table::{Cells, Column, Samples, TIME, Table, cell_error};

/// A mapped column.
struct MappedColumn {
    column: &'static Column,
    /// Its name in the log.
    name: String,
    cell: usize,
    scale: Scale,
}

/// Reads the table below `header`, for a hitch with this linkage.
///
/// # Errors
/// The first fault, with line and column.
pub fn read(
    source: &Arc<SourceFile>,
    header: &Header,
    settings: &ColumnSettings,
    linkage: &Linkage,
) -> Result<Table, CampaignError> {
    let (time, taken) = taken(source, header, settings)?;
    let cells: Vec<usize> = taken.iter().map(|taken| taken.cell).collect();
    let mut reader = Reader {
        source,
        header,
        decimals: Decimals::in_columns(&source.text, header, &cells),
        times: Times::new(time.1),
        time_cell: time.0,
        taken: &taken,
        linkage,
        times_s: Vec::new(),
        values: vec![Vec::new(); taken.len()],
        bytes: Vec::new(),
    };
    // Text after the last sample and an incomplete last row are accepted.
    let mut fault = None;
    for (byte, row) in rows(&source.text, header.data_byte, header.mark) {
        if row.iter().all(str::is_empty) {
            continue;
        }
        if let Some(fault) = fault.take() {
            return Err(fault);
        }
        fault = reader.push(byte, &row)?;
    }
    match fault {
        Some(fault) if reader.bytes.is_empty() => Err(fault),
        _ => reader.table(),
    }
}

/// The time column with its scale, and the other columns.
type Found = ((usize, Option<Scale>), Vec<MappedColumn>);

fn taken(
    source: &SourceFile,
    header: &Header,
    settings: &ColumnSettings,
) -> Result<Found, CampaignError> {
    let mut time = None;
    let mut taken = Vec::new();
    for wanted in &settings.sources {
        let Some(cell) = cell_of(source, header, wanted)? else {
            continue;
        };
        let logged = header.cells[cell].unit.as_deref();
        if is_time(wanted.column) {
            time = Some((cell, wanted.scale(logged).ok()));
            continue;
        }
        let fault =
            |(what, mend)| cell_error(source, header.byte, (cell, header.mark.into()), what, mend);
        taken.push(MappedColumn {
            column: wanted.column,
            name: wanted.name.clone(),
            cell,
            scale: wanted.scale(logged).map_err(fault)?,
        });
    }
    let time = time.ok_or_else(|| {
        let what = format!("no column is assigned to {TIME}");
        let mend = format!("assign it under [columns]: {TIME} = \"Name:s\"");
        source.error_at(header.byte, what, mend)
    })?;
    Ok((time, taken))
}

/// Index of a column; `None` if it is missing and optional.
fn cell_of(
    source: &SourceFile,
    header: &Header,
    wanted: &Source,
) -> Result<Option<usize>, CampaignError> {
    let mut cells = (0..header.cells.len()).filter(|&cell| header.cells[cell].is(&wanted.name));
    match (cells.next(), cells.next()) {
        (Some(cell), None) => Ok(Some(cell)),
        (Some(_), Some(second)) => {
            let what = format!("column {} is duplicated", quote(&wanted.name));
            let place = (second, header.mark.into());
            let mend = "rename one of the two";
            Err(cell_error(source, header.byte, place, what, mend))
        }
        (None, _) if !wanted.is_required => Ok(None),
        (None, _) => {
            let what = format!(
                "column {} does not exist; [columns] assigns it to {}",
                quote(&wanted.name),
                wanted.column.name
            );
            let mend = offer_columns(&wanted.name, &header.names());
            Err(source.error_at(header.byte, what, mend))
        }
    }
}

/// The rows read so far.
struct Reader<'a> {
    source: &'a Arc<SourceFile>,
    header: &'a Header,
    decimals: Decimals,
    times: Times,
    time_cell: usize,
    taken: &'a [MappedColumn],
    linkage: &'a Linkage,
    times_s: Vec<f64>,
    values: Vec<Vec<f64>>,
    /// Byte offset of each row in the file.
    bytes: Vec<usize>,
}

impl Reader<'_> {
    /// Adds a row. A fault that is tolerated in the last row is returned as a value.
    fn push(
        &mut self,
        byte: usize,
        row: &StringRecord,
    ) -> Result<Option<CampaignError>, CampaignError> {
        let cells = self.taken.iter().map(|taken| taken.cell);
        let needed = cells.fold(self.time_cell, usize::max) + 1;
        if row.len() < needed {
            let what = format!(
                "the row has {} cells, the header has {}",
                row.len(),
                self.header.cells.len()
            );
            let mend = "write the separators of empty cells too";
            return Ok(Some(self.source.error_at(byte, what, mend)));
        }
        let cell = &row[self.time_cell];
        let Some(time_s) = self.times.read(cell) else {
            let what = format!(
                "{} is not a time in the format of the previous ones",
                quote(cell)
            );
            let mend = "every row needs a time: a number, a date with a time, or a time of day";
            return Ok(Some(self.fault(byte, self.time_cell, what, mend)));
        };
        for (index, taken) in self.taken.iter().enumerate() {
            let value = self.value(taken, &row[taken.cell]);
            let value = value.map_err(|(what, mend)| self.fault(byte, taken.cell, what, &mend))?;
            self.values[index].push(value);
        }
        self.times_s.push(time_s);
        self.bytes.push(byte);
        Ok(None)
    }

    /// The value of a cell in the column's unit; a cell without digits is a dropout.
    fn value(&self, taken: &MappedColumn, cell: &str) -> Result<f64, (String, String)> {
        let MappedColumn { column, name, .. } = taken;
        if !cell.bytes().any(|byte| byte.is_ascii_digit()) {
            return Ok(f64::NAN);
        }
        let Some(number) = self.decimals.number(cell) else {
            let what = format!("{} in column {} is not a number", quote(cell), quote(name));
            let mend = "leave the cell of a dropout empty; decimals have a point or a comma, thousands no separator";
            return Err((what, mend.to_owned()));
        };
        let value = taken.scale.apply(number, self.linkage);
        if column.range.contains(&value) {
            return Ok(value);
        }
        let what = format!(
            "{} in column {} would be {} = {value}",
            quote(cell),
            quote(name),
            column.name
        );
        let (low, high) = (column.range.start(), column.range.end());
        let mend = format!(
            "the range is {low} to {high}: check the unit under [columns], and leave the cell of a dropout empty"
        );
        Err((what, mend))
    }

    fn fault(&self, byte: usize, cell: usize, what: String, mend: &str) -> CampaignError {
        cell_error(
            self.source,
            byte,
            (cell, self.header.mark.into()),
            what,
            mend,
        )
    }

    fn table(self) -> Result<Table, CampaignError> {
        if self.bytes.is_empty() {
            let mend = "log the run again";
            return Err(self.source.error("contains a header but no samples", mend));
        }
        let mut columns = vec![Samples {
            name: TIME,
            cell: self.time_cell,
            values: self.times_s,
        }];
        for (taken, values) in self.taken.iter().zip(self.values) {
            if values.iter().all(|value| value.is_nan()) {
                let what = format!("column {} contains no number", quote(&taken.name));
                let mend = "assign another column, or delete its line under [columns]";
                let place = (taken.cell, self.header.mark.into());
                return Err(cell_error(self.source, self.header.byte, place, what, mend));
            }
            columns.push(Samples {
                name: taken.column.name,
                cell: taken.cell,
                values,
            });
        }
        let cells = Cells::Between(self.header.mark.into());
        Table::new(Arc::clone(self.source), columns, self.bytes, cells)
    }
}
