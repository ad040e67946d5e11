//! One run's log, of a test bench's logger or of a bus.
use std::path::Path;

use super::bus_log::{self, BusSettings, Format};
use super::cut::Cut;
use super::table::{LIFT, LOWER, OIL_TEMPERATURE, TIME};
use super::{Bench, CampaignError, Channel, Run, csv_log};
use crate::input_error::InputError;
use crate::source_file::SourceFile;

/// Reads a part of one log; it may hold currents only. `bus` says what is taken if it is that of a bus.
pub fn read(
    path: &Path,
    file: &str,
    cut: Cut,
    bench: Bench,
    oil_temperature_c: f64,
    bus: &BusSettings,
) -> Result<Run, CampaignError> {
    let source = SourceFile::read(path)?;
    let table = match Format::of(path) {
        Some(format) => bus_log::read(&source, format, bus)?,
        None => csv_log::read(&source)?,
    };
    let table = table.cut(cut)?;
    let time_s = table.required(TIME)?;
    table.check_time(time_s)?;
    let lift_current_a = table.current(LIFT, time_s)?;
    let lower_current_a = table.current(LOWER, time_s)?;
    let channels = Channel::ALL.map(|channel| {
        let measurable = channel != Channel::RockerAngle || matches!(bench, Bench::Hitch { .. });
        table.measured(channel.key()).filter(|_| measurable)
    });
    Ok(Run {
        file: cut.name(file),
        bench,
        oil_temperature_c,
        time_s: time_s.to_vec(),
        lift_current_a,
        lower_current_a,
        channels,
        oil_temperature_log_c: table.measured(OIL_TEMPERATURE),
    })
}

/// Refuses a run that has nothing to compare a model with.
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
