//! The log of a run: from a test bench's logger, a bus, or a measurement tool.

use std::path::Path;
use std::sync::Arc;

use hitch_input::input_error::InputError;
use hitch_input::source_file::SourceFile;
use hitch_plant::{Channel, Linkage};

use crate::bus_log::{BusSettings, Format};
use crate::columns::ColumnSettings;
use crate::cut::Cut;
#[cfg(feature = "mdf")]
use crate::mdf_log::{self, MdfFile};
use crate::number_log::NumberLog;
use crate::recorded::{Bench, CampaignError, Run};
use crate::run_columns::{LIFT, LOWER, OIL_TEMPERATURE, TIME};
use crate::scale::nominal_linkage;
use crate::table::{LONGEST_STEP_S, Table};
use crate::{bus_log, channel_log, csv_log, left_out};

/// Oil temperature of a run without a stated or logged one, degrees Celsius: that of the paper's valve tables.
const ASSUMED_OIL_TEMPERATURE_C: f64 = 40.0;

/// Interpretation of the logs of a campaign.
#[derive(Debug, Clone, Copy)]
pub struct Settings<'s> {
    /// Bus settings; by default those of the project's ECU.
    pub bus: Option<&'s BusSettings>,
    /// Mapping of the columns of a table or of MDF; by default the project's names.
    pub columns: Option<&'s ColumnSettings>,
    /// The linkage, for the conversion of cylinder travel to rocker angle.
    pub linkage: &'s Linkage,
    /// Longest accepted step between two samples, s.
    pub longest_step_s: f64,
}

impl Default for Settings<'_> {
    fn default() -> Self {
        Self {
            bus: None,
            columns: None,
            linkage: nominal_linkage(),
            longest_step_s: LONGEST_STEP_S,
        }
    }
}

/// Reads a whole log.
///
/// # Errors
/// The first fault, with file, line and column.
pub fn table(path: &Path, settings: Settings<'_>) -> Result<Table, CampaignError> {
    bus_log::check_known(path)?;
    left_out::check(path)?;
    if let Some(format) = Format::of(path) {
        let source = Arc::new(format.source(path)?);
        let ecu = BusSettings::default();
        return bus_log::read(&source, format, settings.bus.unwrap_or(&ecu));
    }
    #[cfg(feature = "mdf")]
    if mdf_log::is_mdf(path) {
        let file = MdfFile::open(path)?;
        return channel_log::read(&file, settings.columns, settings.linkage);
    }
    if let Some(log) = NumberLog::open(path)? {
        return channel_log::read(&log, settings.columns, settings.linkage);
    }
    let source = Arc::new(SourceFile::read_any(path)?);
    csv_log::read(&source, settings.columns, settings.linkage)
}

/// The run of a part of a log, without a step above `longest_step_s`; it may contain only currents. The oil temperature is the stated one, else the mean of the
/// log, else an assumed one.
///
/// # Errors
/// The first fault, with file, line and column.
pub fn run(
    table: &Table,
    file: &str,
    cut: Cut,
    bench: Bench,
    stated_temperature_c: Option<f64>,
    longest_step_s: f64,
) -> Result<Run, CampaignError> {
    let table = table.cut(cut)?;
    let time_s = table.required(TIME)?;
    table.check_time(time_s, longest_step_s)?;
    let lift_current_a = table.current(LIFT, time_s)?;
    let lower_current_a = table.current(LOWER, time_s)?;
    let channels = Channel::ALL.map(|channel| {
        let measurable = channel != Channel::RockerAngle || matches!(bench, Bench::Hitch { .. });
        table.measured(channel.key()).filter(|_| measurable)
    });
    let oil_temperature_log_c = table.measured(OIL_TEMPERATURE);
    let known_temperature_c =
        stated_temperature_c.or_else(|| mean(oil_temperature_log_c.as_deref()?));
    Ok(Run {
        file: cut.name(file),
        bench,
        oil_temperature_c: known_temperature_c.unwrap_or(ASSUMED_OIL_TEMPERATURE_C),
        oil_temperature_known: known_temperature_c.is_some(),
        time_s: time_s.to_vec(),
        lift_current_a,
        lower_current_a,
        channels,
        oil_temperature_log_c,
    })
}

/// Mean of the samples that are not dropouts.
fn mean(samples: &[f64]) -> Option<f64> {
    let finite = || samples.iter().filter(|sample| sample.is_finite());
    let count = finite().count();
    (count > 0).then(|| finite().sum::<f64>() / count as f64)
}

/// Rejects a run without any measured channel.
pub fn check_usable(path: &Path, run: &Run) -> Result<(), CampaignError> {
    if run.channels.iter().any(Option::is_some) {
        return Ok(());
    }
    let known = Channel::ALL.map(Channel::key).join(", ");
    Err(InputError::of_file(
        path,
        "has no usable channel",
        format!("log at least one of {known}"),
    ))
}
