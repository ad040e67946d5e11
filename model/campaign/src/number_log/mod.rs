//! Logs of numbers in binary files: MAT files of MATLAB, and Parquet.
//!
//! A column either has its own times (a time series of MATLAB), or those of the column that is assigned to `time_s`.

mod mat;
mod mat_columns;
mod parquet;

use std::path::Path;

use hitch_input::file_kind;
use hitch_input::input_error::quote;
use hitch_input::source_file::SourceFile;

use crate::CampaignError;
use crate::channel_log::{self, ChannelFile, LogChannel};
use crate::columns::Source;
use crate::csv_log::clock::Times;
use crate::scale::spelling;
use crate::series::Series;
use crate::survey::{LogColumn, Survey};
use crate::table::TIME;

/// Most numbers of a file: as text they would fill the longest file that is read.
const MOST_NUMBERS: usize = 64 << 20;

/// A column of numbers.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct NumberColumn {
    name: String,
    unit: Option<String>,
    /// NaN where there is none.
    values: Vec<f64>,
    /// Its own times as logged; `None` if it has those of another column.
    times: Option<Vec<f64>>,
}

/// A file, read completely.
#[derive(Debug)]
pub struct NumberLog {
    source: SourceFile,
    channels: Vec<LogChannel>,
    columns: Vec<NumberColumn>,
}

/// A fault of a file: what is wrong, and how to mend it.
type Fault = (String, &'static str);

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
            "mat" if file_kind::is_mat(&bytes) => mat_columns::read(&bytes),
            "parquet" if file_kind::is_parquet(&bytes) => parquet::read(bytes),
            _ => return Ok(None),
        };
        let source = SourceFile::named(path);
        let columns = columns.map_err(|(what, mend)| source.error(what, mend))?;
        let channel = |column: &NumberColumn| LogChannel {
            name: column.name.clone(),
            unit: column.unit.clone(),
            samples: column.values.len(),
        };
        Ok(Some(Self {
            channels: columns.iter().map(channel).collect(),
            source,
            columns,
        }))
    }

    /// Its columns: those with their own times if there are any, else all, one of which has to contain times.
    pub fn survey(&self) -> Survey {
        let is_timed = |column: &&NumberColumn| column.times.is_some();
        let timed: Vec<LogColumn> = self.columns.iter().filter(is_timed).map(listed).collect();
        match timed.is_empty() {
            true => Survey::Table(self.columns.iter().map(listed).collect()),
            false => Survey::Channels(timed),
        }
    }

    /// The times of a column, as logged, with their unit.
    fn times<'s>(
        &'s self,
        column: &'s NumberColumn,
        time: Option<&Source>,
    ) -> Result<(&'s [f64], Times), CampaignError> {
        if let Some(own) = &column.times {
            return Ok((own, Times::new(None)));
        }
        let Some(time) = time else {
            let what = format!("no column is assigned to {TIME}");
            let mend = format!("assign it under [columns]: {TIME} = \"Name:s\"");
            return Err(self.source.error(what, mend));
        };
        let found = self.columns.iter().find(|column| column.name == time.name);
        let found = found.ok_or_else(|| channel_log::missing(self, time))?;
        if found.values.len() != column.values.len() {
            let what = format!(
                "column {} has {} values, and {} of the times has {}",
                quote(&column.name),
                column.values.len(),
                quote(&found.name),
                found.values.len()
            );
            let mend = "assign the times of this column, or save it as a struct with the fields Time and Data";
            return Err(self.source.error(what, mend));
        }
        let scale = time.scale(found.unit.as_deref()).ok();
        Ok((&found.values, Times::new(scale)))
    }
}

fn listed(column: &NumberColumn) -> LogColumn {
    let unit = column.unit.as_deref();
    LogColumn {
        name: column.name.clone(),
        unit: unit.map(|unit| spelling(unit).to_owned()),
        comment: String::new(),
        values: column.values.clone(),
        is_clock: false,
    }
}

impl ChannelFile for NumberLog {
    fn source(&self) -> &SourceFile {
        &self.source
    }

    fn channels(&self) -> &[LogChannel] {
        &self.channels
    }

    fn series(&self, channel: usize, time: Option<&Source>) -> Result<Series, CampaignError> {
        let column = &self.columns[channel];
        let (logged, mut times) = self.times(column, time)?;
        let mut times_s = Vec::with_capacity(logged.len());
        for (index, &number) in logged.iter().enumerate() {
            let time_s = Some(number).filter(|number| number.is_finite());
            let Some(time_s) = time_s.and_then(|number| times.of_number(number)) else {
                let what = format!(
                    "sample {} of {} has no time",
                    index + 1,
                    quote(&column.name)
                );
                let mend = "remove the samples without a time, and save the file again";
                return Err(self.source.error(what, mend));
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
