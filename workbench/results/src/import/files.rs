//! The files of an import: the logs, and the description of a bus.

use std::path::{Path, PathBuf};

use hitch_campaign::survey::{self, LogColumn, Survey};
use hitch_model_file::quoted;

use super::manifest::{lines, path_from};
use super::{Kind, Mapping};
use hitch_output::error::Error;

/// Logs, and the DBC file of a bus.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Files {
    /// The logs, in the given order.
    pub logs: Vec<PathBuf>,
    /// The DBC file.
    pub dbc: Option<PathBuf>,
    /// Whether the frames of a bus are those of the DBC file only as groups of J1939.
    pub is_j1939: bool,
}

/// The columns of a log, or the signals of a bus.
#[derive(Debug, Clone, PartialEq)]
pub struct Columns {
    /// The file, for a heading.
    pub heading: String,
    /// Kind of the log.
    pub kind: Kind,
    /// The columns.
    pub columns: Vec<LogColumn>,
    /// What was assumed about the shape and the times of a table, one line each.
    pub notes: Vec<String>,
}

impl Files {
    /// Separates the DBC file from the logs.
    ///
    /// # Errors
    /// If there are several DBC files.
    pub fn sort(files: &[PathBuf]) -> Result<Self, Error> {
        let is_dbc = |file: &&PathBuf| {
            let end = file.extension();
            end.is_some_and(|end| end.eq_ignore_ascii_case("dbc"))
        };
        let (dbcs, logs): (Vec<&PathBuf>, Vec<&PathBuf>) = files.iter().partition(is_dbc);
        if let [_, second, ..] = dbcs[..] {
            let name = second.display();
            return Err(Error::Usage(format!(
                "{name}: is a second DBC file; a campaign has one"
            )));
        }
        Ok(Self {
            logs: logs.into_iter().cloned().collect(),
            dbc: dbcs.first().map(|dbc| (*dbc).clone()),
            is_j1939: false,
        })
    }

    /// The signals of the bus logs that the DBC file describes; `None` without a DBC file.
    ///
    /// # Errors
    /// If a file cannot be read, or there is no log of a bus.
    pub fn signals(&mut self) -> Result<Option<Columns>, Error> {
        let Some(dbc) = &self.dbc else {
            return Ok(None);
        };
        let mut columns: Vec<LogColumn> = Vec::new();
        let mut unknown_frames = 0;
        for file in self.logs.iter().filter(|file| survey::is_bus(file)) {
            let found = survey::bus_signals(file, dbc)?;
            self.is_j1939 |= found.is_j1939;
            unknown_frames += found.unknown_frames;
            for column in found.columns {
                let is_new = columns.iter().all(|known| known.name != column.name);
                columns.extend(is_new.then_some(column));
            }
        }
        let name = dbc.display();
        if columns.is_empty() {
            return Err(Error::Usage(format!(
                "{name}: describes a bus, but no log of a bus (.log, .asc, .blf, frames in MDF or CSV) is given"
            )));
        }
        let heading = match unknown_frames {
            0 => name.to_string(),
            frames => {
                format!("{name} ({frames} frames of messages that it does not define are ignored)")
            }
        };
        let by_group = "assumed: messages with 29 bits are groups of J1939: other priorities and source addresses than \
                        those of the DBC are accepted";
        Ok(Some(Columns {
            heading,
            kind: Kind::Signals,
            columns,
            notes: self
                .is_j1939
                .then(|| by_group.to_owned())
                .into_iter()
                .collect(),
        }))
    }

    /// `[can]` of the manifest in `folder`, if a DBC file is given, and the signals are assigned.
    #[must_use]
    pub fn can(&self, folder: &Path, signals: Option<&Mapping>) -> Option<String> {
        let (dbc, signals) = self.dbc.as_ref().zip(signals)?;
        let identifiers = if self.is_j1939 {
            "identifiers = \"j1939\"\n"
        } else {
            ""
        };
        Some(format!(
            "\n[can]\ndbc = {}\n{identifiers}\n[can.signals]\n{}",
            quoted(&path_from(folder, dbc)),
            lines(signals)
        ))
    }
}

/// The columns of a log that have to be assigned; `None` for a log with the names of the format, or of a bus.
///
/// # Errors
/// If the log cannot be read.
pub fn columns(log: &Path) -> Result<Option<Columns>, Error> {
    let (columns, notes, kind) = match Survey::of(log)? {
        Survey::Own | Survey::Bus => return Ok(None),
        Survey::Table { columns, notes } => (columns, notes, Kind::Table),
        Survey::Channels { columns, notes } => (columns, notes, Kind::Channels),
    };
    Ok(Some(Columns {
        heading: log.display().to_string(),
        kind,
        columns,
        notes,
    }))
}
