//! The contents of a log, before its columns are mapped.

use std::path::Path;

use hitch_input::input_error::InputError;
use hitch_input::source_file::SourceFile;
use hitch_input::written_unit::above_air;

use crate::bus_log::Format;
#[cfg(feature = "mdf")]
use crate::channel_log;
#[cfg(feature = "mdf")]
use crate::mdf_log::{self, MdfFile};
use crate::number_log::NumberLog;
use crate::recorded::CampaignError;
use crate::run_columns::{COLUMNS, TIME, column};
use crate::scale::is_unit_of;
use crate::{bus_log, columns, csv_log, left_out};

pub use crate::bus_log::Signals;
pub use crate::contents::{LogColumn, OF_GROUP, Survey, without_group};
pub use crate::csv_log::{TextTable, text_table};
pub use crate::time_base::{is_in, is_time_name, is_unit_of_time, unit_size_s, words};

impl Survey {
    /// Surveys a log.
    ///
    /// # Errors
    /// The log cannot be read.
    pub fn of(path: &Path) -> Result<Self, CampaignError> {
        bus_log::check_known(path)?;
        left_out::check(path)?;
        if let Some(format) = Format::of(path) {
            return format.source(path).map(|_| Self::Bus);
        }
        #[cfg(feature = "mdf")]
        if mdf_log::is_mdf(path) {
            let columns = channel_log::survey(&MdfFile::open(path)?);
            let notes = Vec::new();
            return Ok(Self::Channels { columns, notes });
        }
        match NumberLog::open(path)? {
            Some(log) => Ok(log.survey()),
            None => csv_log::survey(&SourceFile::read_any(path)?),
        }
    }
}

/// Whether a file is a bus log, by its name or contents.
#[must_use]
pub fn is_bus(path: &Path) -> bool {
    Format::of(path).is_some()
}

/// Surveys a bus log with the description of a DBC.
///
/// # Errors
/// One of them cannot be read, the log is not a bus log, or it contains no signal of the description.
pub fn bus_signals(path: &Path, dbc: &Path) -> Result<Signals, CampaignError> {
    bus_log::check_known(path)?;
    let description = SourceFile::read_any(dbc)?;
    match Format::of(path) {
        Some(format) => bus_log::signals(&format.source(path)?, format, &description),
        None => {
            let hint = "it is .log, .asc, .blf, or frames in MDF or CSV";
            Err(InputError::of_file(path, "is not a log of a bus", hint))
        }
    }
}

/// The possible columns of a run, each with its unit; the times first.
pub fn run_columns() -> impl Iterator<Item = (&'static str, &'static str)> {
    COLUMNS.iter().map(|column| (column.name, column.unit))
}

/// Whether `unit` is possible for a column of a run.
#[must_use]
pub fn fits(unit: &str, name: &str) -> bool {
    column(name).is_some_and(|column| is_unit_of(unit, column))
}

/// Whether a unit is one of absolute pressures, from which the pressure of air is subtracted.
#[must_use]
pub fn is_absolute(unit: &str) -> bool {
    above_air(unit).is_some()
}

/// The usual units of a column of a run, the one of the format first.
pub fn usual_units(name: &str) -> impl Iterator<Item = &'static str> {
    const USUAL: [&str; 26] = [
        "s", "ms", "us", "min", "h", "A", "mA", "bar", "mbar", "kPa", "MPa", "Pa", "psi", "l/min",
        "l/s", "ml/min", "gpm", "deg", "rad", "mm", "cm", "m", "degC", "K", "degF", "uA",
    ];
    let column = column(name);
    let own = column.map(|column| column.unit);
    let others = USUAL.into_iter().filter(move |unit| {
        let fits = column.is_some_and(|column| is_unit_of(unit, column));
        fits && Some(*unit) != own
    });
    own.into_iter().chain(others)
}

/// Validates a value of `name =` under `[columns]`: the name in the log, with an optional unit.
///
/// # Errors
/// The fault, and a suggested correction, in a line.
pub fn check_source(name: &str, text: &str) -> Result<(String, Option<String>), String> {
    let source =
        columns::Source::parse(name, text).map_err(|(what, hint)| format!("{what}; {hint}"))?;
    Ok((source.name, source.unit))
}

/// Name of the time column.
pub const TIMES: &str = TIME;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn usual_units_are_those_of_the_quantity() {
        for (name, own) in run_columns() {
            let units: Vec<&str> = usual_units(name).collect();
            assert_eq!(units.first(), Some(&own), "{name}");
            assert!(
                units.iter().all(|unit| fits(unit, name)),
                "{name} {units:?}"
            );
        }
        let of = |name| usual_units(name).collect::<Vec<_>>();
        assert_eq!(of("lift_current_a"), ["A", "mA", "uA"]);
        assert!(of("rocker_angle_deg").contains(&"mm"));
        assert_eq!(of("oil_temperature_c"), ["degC", "K", "degF"]);
        assert!(of("moon").is_empty());
    }
}
