//! Logs of numbers in binary files: MAT files of MATLAB, and Parquet.
//!
//! A column either has its own times (a time series of MATLAB), or those of the column that is assigned to `time_s`.

mod mat_columns;
mod number_column;
#[cfg(feature = "parquet")]
mod parquet;

use std::path::Path;

#[cfg(feature = "parquet")]
use hitch_input::file_kind::is_parquet;
use hitch_input::input_error::quote;
use hitch_input::source_file::SourceFile;

use number_column::NumberColumn;

use crate::channel_log::{self, ChannelFile, LogChannel};
use crate::columns::{Source, unassigned};
use crate::contents::{LogColumn, Survey};
use crate::csv_log::clock::{DateOrder, Times};
use crate::recorded::CampaignError;
use crate::run_columns::TIMES;
use crate::series::Series;
use crate::time_base::{self, Seen};

/// A file, read completely.
#[derive(Debug)]
pub struct NumberLog {
    source: SourceFile,
    channels: Vec<LogChannel>,
    columns: Vec<NumberColumn>,
    /// The column of times of each column.
    bases: Vec<Option<usize>>,
    /// What is assumed about the times, one line each.
    notes: Vec<String>,
}

impl NumberLog {
    /// Reads a file; `None` if it is of another format, by its name and first bytes.
    ///
    /// # Errors
    /// The file cannot be read.
    pub fn open(path: &Path) -> Result<Option<Self>, CampaignError> {
        let end = path.extension().and_then(|end| end.to_str());
        let end = end.unwrap_or_default().to_ascii_lowercase();
        if !["mat", "parquet"].contains(&end.as_str()) {
            return Ok(None);
        }
        let bytes = SourceFile::bytes(path)?;
        let columns = match end.as_str() {
            "mat" if hitch_mat_file::is_one(&bytes) => mat_columns::read(&bytes),
            #[cfg(feature = "parquet")]
            "parquet" if is_parquet(&bytes) => parquet::read(bytes),
            _ => return Ok(None),
        };
        let source = SourceFile::named(path);
        let columns = columns.map_err(|(what, hint)| source.error(what, hint))?;
        let channel = |column: &NumberColumn| LogChannel {
            name: column.name.clone(),
            unit: column.unit.clone(),
            samples: column.values.len(),
            fault: None,
        };
        let seen =
            |column: &NumberColumn| Seen::new(&column.name, column.unit.as_deref(), &column.values);
        let seen: Vec<Seen> = columns.iter().map(seen).collect();
        let bases = time_base::bases(&seen);
        Ok(Some(Self {
            channels: columns.iter().map(channel).collect(),
            source,
            notes: time_base::notes(&seen, &bases),
            bases,
            columns,
        }))
    }

    /// Its columns: those with their own times if there are any, else all, one of which has to contain times.
    pub fn survey(&self) -> Survey {
        let is_timed = |column: &&NumberColumn| column.times.is_some();
        let timed: Vec<LogColumn> = self.columns.iter().filter(is_timed).map(listed).collect();
        if timed.is_empty() {
            let mut columns: Vec<LogColumn> = self.columns.iter().map(listed).collect();
            for (column, base) in columns.iter_mut().zip(&self.bases) {
                column.times = base.map(|base| self.columns[base].name.clone());
            }
            let notes = self.notes.clone();
            Survey::Table { columns, notes }
        } else {
            let mut columns = self.columns.iter().filter(is_timed);
            let is_assumed = columns.any(|column| !column.states_times);
            let note = "assumed s: the times of its series, which state no unit";
            Survey::Channels {
                columns: timed,
                notes: is_assumed.then(|| note.to_owned()).into_iter().collect(),
            }
        }
    }

    /// The times of a column, as logged, with their unit.
    fn times<'s>(
        &'s self,
        index: usize,
        time: Option<&Source>,
        lift: Option<usize>,
    ) -> Result<(&'s [f64], Times), CampaignError> {
        let column = &self.columns[index];
        if let Some(own) = &column.times {
            return Ok((own, Times::new(None, DateOrder::default())));
        }
        let Some(time) = time else {
            let (what, hint) = unassigned("column", &TIMES);
            return Err(self.source.error(what, hint));
        };
        let named = self
            .columns
            .iter()
            .position(|column| column.name == time.name);
        let main = named.ok_or_else(|| channel_log::missing(self, time))?;
        let base = time_base::base_of(&self.bases, index, main, lift);
        let found = &self.columns[base];
        if found.values.len() != column.values.len() {
            let what = format!(
                "column {} has {} values, and {} of the times has {}",
                quote(&column.name),
                column.values.len(),
                quote(&found.name),
                found.values.len()
            );
            let hint = "assign the times of this column, or save it as a struct with the fields Time and Data";
            return Err(self.source.error(what, hint));
        }
        let unit = |index: usize| self.columns[index].unit.as_deref();
        let main_scale = time.scale(unit(main)).ok();
        let scale = if base == main {
            main_scale
        } else {
            time_base::scale(unit(base), main_scale)
        };
        Ok((&found.values, Times::new(scale, DateOrder::default())))
    }
}

fn listed(column: &NumberColumn) -> LogColumn {
    LogColumn {
        values: column.values.clone(),
        lasts_s: column.times.as_deref().and_then(channel_log::lasts),
        ..LogColumn::new(&column.name, column.unit.as_deref())
    }
}

impl ChannelFile for NumberLog {
    fn source(&self) -> &SourceFile {
        &self.source
    }

    fn channels(&self) -> &[LogChannel] {
        &self.channels
    }

    fn series(
        &self,
        channel: usize,
        time: Option<&Source>,
        lift: Option<usize>,
    ) -> Result<Series, CampaignError> {
        let column = &self.columns[channel];
        let (logged, mut times) = self.times(channel, time, lift)?;
        let mut times_s = Vec::with_capacity(logged.len());
        for (index, &number) in logged.iter().enumerate() {
            let time_s = Some(number).filter(|number| number.is_finite());
            let Some(time_s) = time_s.and_then(|number| times.of_number(number)) else {
                let what = format!(
                    "sample {} of {} has no time",
                    index + 1,
                    quote(&column.name)
                );
                let hint = "remove the samples without a time, and save the file again";
                return Err(self.source.error(what, hint));
            };
            times_s.push(time_s);
        }
        Ok(Series {
            bytes: vec![0; times_s.len()],
            times_s,
            values: column.values.clone(),
        })
    }
}
