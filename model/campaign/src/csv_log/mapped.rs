//! Reads any table, mapped by `[columns]`: its own names, units and times, each column at its own rate.

use std::sync::Arc;

use hitch_input::input_error::quote;
use hitch_input::source_file::SourceFile;
use hitch_plant::Linkage;

use crate::columns::{ColumnSettings, Source, unassigned};
use crate::csv_log::clock::Times;
use crate::csv_log::decimals::is_missing;
use crate::csv_log::layout::{Layout, Row};
use crate::recorded::CampaignError;
use crate::run_columns::{Column, LIFT, TIMES};
use crate::scale::{Scale, is_time};
use crate::series::Series;
use crate::table::{Cells, Table};
use crate::time_base::{self, base_of};

/// A mapped column.
struct MappedColumn {
    column: &'static Column,
    /// Its name in the log.
    name: String,
    index: usize,
    scale: Scale,
    /// Index of its times among those that are read.
    times: usize,
    values: Vec<f64>,
    /// Whether the log has the name and the unit of the format.
    is_own: bool,
}

/// A column of times.
struct TimeColumn {
    index: usize,
    times: Times,
    times_s: Vec<f64>,
    /// Byte offset of each row in the file.
    bytes: Vec<usize>,
}

/// The rows read so far.
struct Reader<'a> {
    layout: &'a Layout<'a>,
    linkage: &'a Linkage,
    /// The assigned times first.
    times: Vec<TimeColumn>,
    columns: Vec<MappedColumn>,
}

/// Reads the table of a layout, for a hitch with this linkage.
///
/// # Errors
/// The first fault, with line and column.
pub fn read(
    source: &Arc<SourceFile>,
    layout: &Layout<'_>,
    settings: &ColumnSettings,
    linkage: &Linkage,
) -> Result<Table, CampaignError> {
    let mut reader = Reader::new(source, layout, settings, linkage)?;
    let below = layout.each_row(|row| reader.push(row))?;
    match below.fault {
        // Only another logger's file may end with remarks, or in the middle of a row.
        Some(fault) if settings.are_own_names() => Err(fault),
        _ => reader.table(source),
    }
}

/// Index of a column; `None` if it is missing and optional.
fn index_of(
    source: &SourceFile,
    layout: &Layout<'_>,
    wanted: &Source,
) -> Result<Option<usize>, CampaignError> {
    let cells = &layout.header.cells;
    if let Some(exact) = cells.iter().position(|cell| cell.name == wanted.name) {
        return Ok(Some(exact));
    }
    let mut found = (0..cells.len()).filter(|&index| cells[index].is(&wanted.name));
    match (found.next(), found.next()) {
        (Some(index), None) => Ok(Some(index)),
        (Some(first), Some(second)) => {
            let what = format!("column {} is duplicated", quote(&wanted.name));
            let hint = format!("assign {} or {}", cells[first].name, cells[second].name);
            Err(layout.fault_of_name(second, what, &hint))
        }
        (None, _) if !wanted.is_required => Ok(None),
        (None, _) => {
            let (what, hint) = wanted.missing("column", &layout.header.names());
            Err(source.error_at(layout.header.byte, what, hint))
        }
    }
}

impl<'a> Reader<'a> {
    fn new(
        source: &SourceFile,
        layout: &'a Layout<'a>,
        settings: &ColumnSettings,
        linkage: &'a Linkage,
    ) -> Result<Self, CampaignError> {
        let mut found: Vec<(&Source, usize)> = Vec::new();
        for wanted in &settings.sources {
            found.extend(index_of(source, layout, wanted)?.map(|index| (wanted, index)));
        }
        let time = found.iter().find(|(wanted, _)| is_time(wanted.column));
        let &(time, main) = time.ok_or_else(|| {
            let (what, hint) = unassigned("column", &TIMES);
            source.error_at(layout.header.byte, what, hint)
        })?;
        let unit = |index: usize| layout.header.cells[index].unit.as_deref();
        let column_of = |index: usize, scale| TimeColumn {
            index,
            times: Times::new(scale, layout.orders[index]),
            times_s: Vec::new(),
            bytes: Vec::new(),
        };
        let main_scale = time.scale(unit(main)).ok();
        let mut times = vec![column_of(main, main_scale)];
        let lift = found.iter().find(|(wanted, _)| wanted.column.name == LIFT);
        let lift = lift.map(|(_, index)| *index);
        let mut columns = Vec::new();
        for (wanted, index) in found
            .into_iter()
            .filter(|(wanted, _)| !is_time(wanted.column))
        {
            let scale = wanted.scale(unit(index));
            let scale = scale.map_err(|(what, hint)| layout.fault_of_name(index, what, &hint))?;
            let base = base_of(&layout.bases, index, main, lift);
            let known = times.iter().position(|times| times.index == base);
            let place = known.unwrap_or(times.len());
            if known.is_none() {
                times.push(column_of(base, time_base::scale(unit(base), main_scale)));
            }
            columns.push(MappedColumn {
                column: wanted.column,
                name: wanted.name.clone(),
                index,
                scale,
                times: place,
                values: Vec::new(),
                is_own: settings.are_own_names(),
            });
        }
        Ok(Self {
            layout,
            linkage,
            times,
            columns,
        })
    }

    /// Adds a row. A fault that is tolerated in the last row is returned as a value.
    fn push(&mut self, row: Row<'_>) -> Result<Option<CampaignError>, CampaignError> {
        let layout = self.layout;
        for (place, time) in self.times.iter_mut().enumerate() {
            let cell = row.cell(time.index);
            let own = || (0..self.columns.len()).filter(|&own| self.columns[own].times == place);
            // A slow rate has fewer rows than a fast one.
            if cell.is_empty() && own().all(|own| row.cell(self.columns[own].index).is_empty()) {
                continue;
            }
            let Some(time_s) = time.times.read(cell) else {
                return Ok(Some(layout.no_time(
                    row,
                    time.index,
                    !time.times_s.is_empty(),
                )));
            };
            for own in own().collect::<Vec<usize>>() {
                let index = self.columns[own].index;
                let value = value(&self.columns[own], layout, self.linkage, row.cell(index));
                let value =
                    value.map_err(|(what, hint)| layout.fault(row.byte, index, what, &hint))?;
                self.columns[own].values.push(value);
            }
            time.times_s.push(time_s);
            time.bytes.push(row.byte);
        }
        Ok(None)
    }

    /// The rows of the times of the lift current, to which samples at other times are moved.
    fn table(self, source: &Arc<SourceFile>) -> Result<Table, CampaignError> {
        let layout = self.layout;
        let mut columns = self.columns.iter();
        let lift = columns.find(|column| column.column.name == LIFT);
        let main = lift.map_or(0, |lift| lift.times);
        let rows = &self.times[main];
        if rows.bytes.is_empty() {
            let hint = "log the run again";
            return Err(source.error("contains a header but no samples", hint));
        }
        let mut columns = Vec::new();
        for taken in &self.columns {
            let times = &self.times[taken.times];
            if !taken.is_own && taken.values.iter().all(|value| value.is_nan()) {
                let what = format!("column {} contains no number", quote(&taken.name));
                let hint = "assign another column, or delete its line under [columns]";
                return Err(layout.fault_of_name(taken.index, what, hint));
            }
            if taken.times != main {
                times.check(layout)?;
            }
            let later_s = times.times.later_than_s(&rows.times);
            let series = times.series(later_s, taken.values.clone());
            columns.push((taken.column.name, layout.cell(taken.index), series));
        }
        let series = columns.iter();
        let series = series.map(|(name, cell, series)| (*name, *cell, series));
        let cells = Cells::Between(layout.header.mark.into());
        let own = rows.series(0.0, Vec::new());
        let table = Table::of_series(source, (layout.cell(rows.index), &own), series, cells)?;
        Ok(table.since(rows.times.origin_s()))
    }
}

impl TimeColumn {
    /// Values at these times, later by `later_s`.
    fn series(&self, later_s: f64, values: Vec<f64>) -> Series {
        let times_s = self.times_s.iter().map(|time_s| time_s + later_s);
        Series {
            times_s: times_s.collect(),
            values,
            bytes: self.bytes.clone(),
        }
    }

    /// Rejects times that do not rise.
    fn check(&self, layout: &Layout<'_>) -> Result<(), CampaignError> {
        let pairs = self.times_s.windows(2);
        let Some(at) = pairs.clone().position(|pair| pair[1] <= pair[0]) else {
            return Ok(());
        };
        let what = format!(
            "time does not rise: {} s after {} s",
            self.times_s[at + 1],
            self.times_s[at]
        );
        let hint = "the times of each rate have to rise from row to row";
        Err(layout.fault(self.bytes[at + 1], self.index, what, hint))
    }
}

/// The value of a cell in the column's unit; a cell without digits is a dropout.
fn value(
    taken: &MappedColumn,
    layout: &Layout<'_>,
    linkage: &Linkage,
    cell: &str,
) -> Result<f64, (String, String)> {
    let MappedColumn { column, name, .. } = taken;
    if cell.is_empty() || (is_missing(cell) && !taken.is_own) {
        return Ok(f64::NAN);
    }
    let Some(number) = layout.decimals[taken.index].number(cell) else {
        let what = format!("{} in column {} is not a number", quote(cell), quote(name));
        let hint = "leave the cell of a dropout empty; decimals have a point or a comma, thousands no separator";
        return Err((what, hint.to_owned()));
    };
    let value = taken.scale.apply(number, linkage);
    let empty = "leave the cell of a dropout empty";
    column.checked(value).map_err(|(would_be, range)| {
        if taken.is_own {
            (
                format!("{value} in column {name} is out of range"),
                format!("{range}; {empty}"),
            )
        } else {
            (
                format!("{} in column {} {would_be}", quote(cell), quote(name)),
                format!("{range}: check the unit under [columns], and {empty}"),
            )
        }
    })
}
