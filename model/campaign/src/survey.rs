//! What a log holds, before anybody has said which of its columns is which.

use std::path::Path;

use hitch_input::source_file::SourceFile;

use crate::bus_log::Format;
use crate::mdf_log::MdfFile;
use crate::scale::{is_unit_of, spelling};
use crate::table::{COLUMNS, TIME, column};
use crate::{CampaignError, bus_log, columns, csv_log, mdf_log};

pub use crate::bus_log::Signals;

/// A column of a table, or a channel.
#[derive(Debug, Clone, PartialEq)]
pub struct LogColumn {
    /// Its name.
    pub name: String,
    /// Its unit as formulas write it, if the log says one.
    pub unit: Option<String>,
    /// What people say about it; empty if nothing.
    pub comment: String,
    /// Its numbers, as the log has them; NaN where there is none, and none at all if they weren't looked at.
    pub values: Vec<f64>,
    /// It holds dates or times of day.
    pub is_clock: bool,
}

/// What kind of log it is.
#[derive(Debug, Clone, PartialEq)]
pub enum Survey {
    /// A table with these columns; it needs one of times.
    Table(Vec<LogColumn>),
    /// A table with this project's own names.
    Own,
    /// Channels that know their times.
    Channels(Vec<LogColumn>),
    /// Frames of a bus.
    Bus,
}

impl Survey {
    /// Looks into a log.
    ///
    /// # Errors
    /// If it can't be read at all.
    pub fn of(path: &Path) -> Result<Self, CampaignError> {
        if mdf_log::is_mdf(path) {
            return channels(path);
        }
        let source = SourceFile::read_any(path)?;
        bus_log::check_known(path)?;
        match Format::of(path) {
            Some(_) => Ok(Self::Bus),
            None => csv_log::survey(&source),
        }
    }
}

/// Whether a file is a log of a bus, by its name.
#[must_use]
pub fn is_bus(path: &Path) -> bool {
    Format::of(path).is_some()
}

/// Looks into a log of a bus with the description that a DBC gives.
///
/// # Errors
/// If one of them can't be read, the log is not of a bus, or holds nothing of the description.
pub fn bus_signals(path: &Path, dbc: &Path) -> Result<Signals, CampaignError> {
    let source = SourceFile::read_any(path)?;
    let description = SourceFile::read_any(dbc)?;
    match Format::of(path) {
        Some(format) => bus_log::signals(&source, format, &description),
        None => Err(source.error("is no log of a bus", "its name ends in .log or .asc")),
    }
}

fn channels(path: &Path) -> Result<Survey, CampaignError> {
    let file = MdfFile::open(path)?;
    let mut columns: Vec<LogColumn> = Vec::new();
    for channel in &file.channels {
        // What can't be read is not offered; the reader says why if somebody names it.
        let Ok(series) = file.series(channel) else {
            continue;
        };
        let known = columns.iter().any(|column| column.name == channel.name);
        if !known && !series.values.is_empty() {
            columns.push(LogColumn {
                name: channel.name.clone(),
                unit: channel
                    .unit
                    .as_deref()
                    .map(|unit| spelling(unit).to_owned()),
                comment: String::new(),
                values: series.values,
                is_clock: false,
            });
        }
    }
    Ok(Survey::Channels(columns))
}

/// The columns that a run may have, each with its unit; the times first.
pub fn run_columns() -> impl Iterator<Item = (&'static str, &'static str)> {
    COLUMNS.iter().map(|column| (column.name, column.unit))
}

/// Whether values in `unit` can be those of a run's column.
#[must_use]
pub fn fits(unit: &str, name: &str) -> bool {
    column(name).is_some_and(|column| is_unit_of(unit, column))
}

/// Checks what somebody wrote behind `name =` under `[columns]`: the name in the log, and the unit if it has one.
///
/// # Errors
/// What is wrong, and how to mend it, in a line.
pub fn check_source(name: &str, text: &str) -> Result<(String, Option<String>), String> {
    let source =
        columns::Source::parse(name, text).map_err(|(what, mend)| format!("{what}; {mend}"))?;
    Ok((source.name, source.unit))
}

/// Name of the column of times.
pub const TIMES: &str = TIME;
