//! The description of a text table: dialect, shape and times. The survey, the readers and their messages follow from it.

use csv::StringRecord;
use hitch_input::input_error::quote;
use hitch_input::source_file::SourceFile;

use crate::cell_error::cell_error;
use crate::csv_log::clock::{DateOrder, Times, is_clock, is_date};
use crate::csv_log::decimals::{Decimals, is_missing};
use crate::csv_log::dialect::is_sample;
use crate::csv_log::lvm::{self, Steps};
use crate::csv_log::text_rows::{Header, rows};
use crate::recorded::CampaignError;
use crate::series::rises;
use crate::time_base::{Seen, bases, is_time_name, notes};

/// Number of rows that are examined.
const EXAMINED_ROWS: usize = 1_000;

/// A table below a header.
#[derive(Debug)]
pub struct Layout<'s> {
    source: &'s SourceFile,
    /// Times that are not in a column.
    steps: Option<Steps>,
    /// Separator, names and units.
    pub header: Header,
    /// Number of cells of a row before its first named cell: 1 with row names.
    shift: usize,
    /// Form of the numbers, by column.
    pub decimals: Vec<Decimals>,
    /// Order of day and month, by column.
    pub orders: Vec<DateOrder>,
    /// The column of times of each column.
    pub bases: Vec<Option<usize>>,
    /// What was assumed, one line each.
    pub notes: Vec<String>,
}

/// The lines below the samples of a table, which are left out.
#[derive(Debug, Default)]
pub struct Below {
    /// Their number.
    pub lines: usize,
    /// The fault of the first one.
    pub fault: Option<CampaignError>,
}

/// A row of a table.
#[derive(Debug, Clone, Copy)]
pub struct Row<'r> {
    /// Its byte offset in the text.
    pub byte: usize,
    record: &'r StringRecord,
    shift: usize,
}

impl<'r> Row<'r> {
    /// The text of a column; empty without one.
    pub fn cell(&self, column: usize) -> &'r str {
        self.record.get(column + self.shift).unwrap_or_default()
    }

    /// Whether each cell is empty or begins with `#`.
    pub fn is_remark(&self) -> bool {
        let mut cells = self.record.iter();
        cells.all(|cell| cell.is_empty() || cell.starts_with('#'))
    }
}

impl<'s> Layout<'s> {
    /// Examines the first rows below a header.
    pub fn new(source: &'s SourceFile, header: Header) -> Self {
        let mut layout = Self {
            source,
            steps: lvm::steps(&source.text, &header),
            shift: 0,
            decimals: Vec::new(),
            orders: Vec::new(),
            bases: Vec::new(),
            notes: Vec::new(),
            header,
        };
        let first: Vec<StringRecord> = layout
            .records()
            .take(EXAMINED_ROWS)
            .map(|(_, row)| row)
            .filter(|row| !row.iter().all(str::is_empty))
            .collect();
        if layout.has_row_names(&first) {
            layout.shift = 1;
            let names = "the first cell of each row has no name above it: it is read as the name of the row";
            layout.notes.push(names.to_owned());
        }
        layout.decimals = layout.decimals_of(&first);
        layout.orders = layout.orders_of(&first);
        let seen: Vec<Seen> = (0..layout.header.cells.len())
            .map(|column| layout.seen(column, &first))
            .collect();
        layout.bases = bases(&seen);
        layout.notes.extend(notes(&seen, &layout.bases));
        layout.note_dates(&seen, &first);
        layout
    }

    /// The rows below the header, each with its byte offset and its time.
    fn records(&self) -> impl Iterator<Item = (usize, StringRecord)> {
        let rows = rows(&self.source.text, self.header.data_byte, self.header.mark);
        let mut segments = lvm::Segments::of(&self.source.text, self.steps);
        rows.filter_map(move |(byte, row)| Some((byte, segments.sample(row)?)))
    }

    /// Whether each row has one more cell than the header, the first of which names the row.
    fn has_row_names(&self, rows: &[StringRecord]) -> bool {
        let (width, cells) = (self.header.width, &self.header.cells);
        let rows: Vec<&StringRecord> = rows.iter().filter(|row| is_sample(row)).collect();
        let is_longer = rows.len() > 1 && rows.iter().all(|row| row.len() == width + 1);
        if !is_longer || rows.iter().all(|row| row[width].is_empty()) {
            return false;
        }
        let number = |row: &&StringRecord, cell: usize| Decimals::ANY.number(&row[cell]);
        let first: Vec<Option<f64>> = rows.iter().map(|row| number(row, 0)).collect();
        if first.iter().all(Option::is_none) {
            return rows.iter().all(|row| !is_clock(&row[0]));
        }
        let counts = |pair: &[Option<f64>]| match (pair[0], pair[1]) {
            (Some(a), Some(b)) => a.fract() == 0.0 && b > a,
            _ => false,
        };
        // A column of times has to be one behind the row names as well: otherwise the further cell may be the last one.
        let second: Vec<f64> = rows.iter().filter_map(|row| number(row, 1)).collect();
        let is_clock = || rows.iter().all(|row| is_clock(&row[1]));
        let begins_with_time = cells.first().is_some_and(|cell| is_time_name(&cell.name));
        first.windows(2).all(counts) && begins_with_time && (rises(&second) || is_clock())
    }

    fn decimals_of(&mut self, first: &[StringRecord]) -> Vec<Decimals> {
        let columns = 0..self.header.cells.len();
        let shift = self.shift;
        let cells = |column: usize| first.iter().filter_map(move |row| row.get(column + shift));
        let of_table = Decimals::of(columns.clone().flat_map(cells));
        let mut all = Vec::with_capacity(columns.len());
        for column in columns {
            let filled: Vec<&str> = cells(column).filter(|cell| !is_missing(cell)).collect();
            let (decimals, thousands) = of_table.of_column(&filled);
            if let Some(mark) = thousands {
                let name = &self.header.cells[column].name;
                self.notes.push(format!(
                    "assumed: \"{mark}\" separates thousands in \"{name}\""
                ));
            }
            all.push(decimals);
        }
        all
    }

    /// The order of the dates of each column, from all its rows.
    fn orders_of(&mut self, first: &[StringRecord]) -> Vec<DateOrder> {
        let mut orders = Vec::new();
        for column in 0..self.header.cells.len() {
            let cell = column + self.shift;
            let mut begin = first.iter().filter_map(|row| row.get(cell));
            if !begin.find(|cell| !is_missing(cell)).is_some_and(is_clock) {
                orders.push(DateOrder::default());
                continue;
            }
            let all: Vec<String> = self
                .records()
                .filter_map(|(_, row)| row.get(cell).map(str::to_owned))
                .filter(|cell| is_clock(cell))
                .collect();
            let (order, matters) = DateOrder::of(all.iter().map(String::as_str));
            if matters {
                let name = &self.header.cells[column].name;
                let order = order.name();
                self.notes.push(format!(
                    "assumed: the dates of \"{name}\" are {order}, in which they continue"
                ));
            }
            orders.push(order);
        }
        orders
    }

    /// Notes the columns of dates beside times of day.
    fn note_dates(&mut self, seen: &[Seen], first: &[StringRecord]) {
        let Some(times) = seen.iter().find(|seen| seen.is_clock) else {
            return;
        };
        for (column, dates) in seen.iter().enumerate() {
            let mut cells = first.iter().map(|row| row.get(column + self.shift));
            if cells.next().flatten().is_some_and(is_date) {
                self.notes.push(format!(
                    "the dates of \"{}\" are not read: the times of \"{}\" continue over midnight",
                    dates.name, times.name
                ));
            }
        }
    }

    fn seen(&self, column: usize, first: &[StringRecord]) -> Seen {
        let cell = &self.header.cells[column];
        let cells = first.iter().filter_map(|row| row.get(column + self.shift));
        let filled: Vec<&str> = cells.filter(|cell| !is_missing(cell)).collect();
        let mut times = Times::new(None, self.orders[column]);
        let values: Vec<f64> = filled
            .iter()
            .filter_map(|text| {
                if is_clock(text) {
                    times.read(text)
                } else {
                    self.decimals[column].number(text)
                }
            })
            .collect();
        Seen {
            is_clock: filled.first().is_some_and(|text| is_clock(text)),
            ..Seen::new(&cell.name, cell.unit.as_deref(), &values)
        }
    }

    /// Calls `take` for each row with a sample. A fault that it returns as a value is tolerated in the last row, as are
    /// lines below the samples. Returns these lines.
    ///
    /// # Errors
    /// The first row with more or fewer cells than the header, or fault of `take`.
    pub fn each_row(
        &self,
        mut take: impl FnMut(Row<'_>) -> Result<Option<CampaignError>, CampaignError>,
    ) -> Result<Below, CampaignError> {
        let mut below = Below::default();
        let (mut only_remarks, mut samples) = (true, 0);
        for (byte, record) in self.records() {
            if record.iter().all(str::is_empty) {
                continue;
            }
            let row = Row {
                byte,
                record: &record,
                shift: self.shift,
            };
            let no_time = self.word_for_time(row);
            let found = match (self.misfit(byte, &record), no_time) {
                (Some(misfit), _) => Some(misfit),
                (None, Some(column)) => Some(self.no_time(row, column, samples > 0)),
                (None, None) => take(row)?,
            };
            match (found, below.fault.take()) {
                (None, Some(before)) => return Err(before),
                (None, None) => samples += 1,
                (Some(found), before) => {
                    below.lines += 1;
                    only_remarks &= !is_sample(&record) || no_time.is_some();
                    below.fault = before.or(Some(found));
                }
            }
        }
        match below.fault {
            Some(fault) if samples == 0 || (below.lines > 1 && !only_remarks) => Err(fault),
            _ => Ok(below),
        }
    }

    /// The column of times in which a row has a word, if it has no time: a line below the samples may begin like that.
    fn word_for_time(&self, row: Row<'_>) -> Option<usize> {
        let bases = self.bases.iter().enumerate();
        let times = bases.filter(|(column, base)| **base == Some(*column));
        let mut filled = times.filter(|(column, _)| !row.cell(*column).is_empty());
        let (column, _) = filled.next()?;
        let is_word =
            is_missing(row.cell(column)) && filled.all(|(other, _)| is_missing(row.cell(other)));
        is_word.then_some(column)
    }

    /// The fault of a row without a time, below others or not.
    pub fn no_time(&self, row: Row<'_>, column: usize, is_below: bool) -> CampaignError {
        let as_before = if is_below {
            " in the form of those above"
        } else {
            ""
        };
        let what = format!("{} is not a time{as_before}", quote(row.cell(column)));
        let hint = "every row needs a number, a date with a time of day (21.11.2026 10:00:00.020, \
                    2026-11-21T10:00:00Z, 21-Nov-2026 10:00:00), or a time of day";
        self.fault(row.byte, column, what, hint)
    }

    /// The fault of a row that does not have the cells of the header.
    fn misfit(&self, byte: usize, record: &StringRecord) -> Option<CampaignError> {
        let mut cells = self.header.cells.iter();
        let named = cells.rposition(|cell| !cell.text.is_empty());
        let least = named.map_or(0, |last| last + 1) + self.shift;
        let filled = (0..record.len()).rfind(|&cell| !record[cell].is_empty());
        let most = self.header.width + self.shift;
        let is_long = filled.is_some_and(|last| last >= most);
        if !is_long && record.len() >= least {
            return None;
        }
        let what = format!(
            "the row has {} cells, the header has {}",
            record.len(),
            self.header.width
        );
        let hint = if is_long {
            "each cell needs a name above it: name all columns in the header, and separate the columns by semicolons if numbers have a decimal comma"
        } else {
            "write the separators of empty cells too"
        };
        Some(self.source.error_at(byte, what, hint))
    }

    /// A fault of a cell of a row.
    pub fn fault(&self, byte: usize, column: usize, what: String, hint: &str) -> CampaignError {
        let cell = (self.cell(column), self.header.mark.into());
        cell_error(self.source, byte, cell, what, hint)
    }

    /// A fault of a name in the header.
    pub fn fault_of_name(&self, column: usize, what: String, hint: &str) -> CampaignError {
        let cell = (column, self.header.mark.into());
        cell_error(self.source, self.header.byte, cell, what, hint)
    }

    /// Index of the cell of a column in a row.
    pub fn cell(&self, column: usize) -> usize {
        column + self.shift
    }
}
