//! What a log contains, before its columns are mapped.

use hitch_input::written_unit::spelling;

/// A column of a table, or a channel.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LogColumn {
    /// Its name.
    pub name: String,
    /// Index of its cell in a row of a text table.
    pub cell: usize,
    /// Its unit as formulas write it, if the log states one.
    pub unit: Option<String>,
    /// Its comment; empty without one.
    pub comment: String,
    /// Its numbers as logged; NaN for missing ones, empty if they were not read.
    pub values: Vec<f64>,
    /// Whether it contains dates or times of day.
    pub is_clock: bool,
    /// Name of its column of times, which for one of times is its own; `None` if there is none, or it has its own times.
    pub times: Option<String>,
    /// Time from its first sample to its last one, s, if it has its own times.
    pub lasts_s: Option<f64>,
    /// Why it cannot be used; `None` if it can.
    pub fault: Option<String>,
}

impl LogColumn {
    /// A column without numbers; the log may spell its unit in any way.
    pub(crate) fn new(name: &str, unit: Option<&str>) -> Self {
        Self {
            name: name.to_owned(),
            unit: unit.map(|unit| spelling(unit).to_owned()),
            ..Self::default()
        }
    }
}

/// Separator between the name of a channel and the name of its group, which is added to equal names.
pub const OF_GROUP: &str = " @ ";

/// The name of a channel without that of its group; `None` if it has no group.
#[must_use]
pub fn without_group(name: &str) -> Option<&str> {
    name.split_once(OF_GROUP).map(|(plain, _)| plain)
}

/// Kind of a log.
#[derive(Debug, Clone, PartialEq)]
pub enum Survey {
    /// A table.
    Table {
        /// Its columns; one has to contain times.
        columns: Vec<LogColumn>,
        /// What was assumed about its shape and times, one line each.
        notes: Vec<String>,
    },
    /// A table with the project's own names.
    Own,
    /// Channels with their own times.
    Channels {
        /// The channels with samples.
        columns: Vec<LogColumn>,
        /// What was assumed about their times, one line each.
        notes: Vec<String>,
    },
    /// Frames of a bus.
    Bus,
}
