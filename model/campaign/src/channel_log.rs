//! Logs of channels, each with its own times.
//!
//! A row is a sample of the lift current; other channels are moved to its times, as in bus logs.

use std::sync::Arc;

use hitch_input::input_error::quote;
use hitch_input::source_file::SourceFile;
use hitch_plant::Linkage;

use crate::columns::{ColumnSettings, Source, unassigned};
#[cfg(feature = "mdf")]
use crate::contents::LogColumn;
use crate::contents::without_group;
use crate::recorded::CampaignError;
use crate::run_columns::{LIFT, LIFTS, TIME};
use crate::series::Series;
use crate::table::{Cells, Table};

/// A channel of a log.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LogChannel {
    /// Its name.
    pub name: String,
    /// Its unit; `None` without one.
    pub unit: Option<String>,
    /// Number of samples.
    pub samples: usize,
    /// Why its samples are not numbers; `None` if they are.
    pub fault: Option<&'static str>,
}

/// A log of channels.
pub trait ChannelFile {
    /// The file, without its text.
    fn source(&self) -> &SourceFile;

    /// Its channels other than times.
    fn channels(&self) -> &[LogChannel];

    /// Whether it is a recording that is cut off.
    fn is_cut_off(&self) -> bool {
        false
    }

    /// Whether the last samples of a channel are missing.
    fn is_shortened(&self, _channel: usize) -> bool {
        false
    }

    /// The samples of a channel; NaN where there is no valid one. `time` is the column of times that is assigned to the
    /// channel `lift`, for a format in which channels may lack times of their own.
    ///
    /// # Errors
    /// The samples cannot be read, or have no times.
    fn series(
        &self,
        channel: usize,
        time: Option<&Source>,
        lift: Option<usize>,
    ) -> Result<Series, CampaignError>;
}

/// Reads a log for a hitch with this linkage.
///
/// # Errors
/// The first fault.
pub fn read(
    file: &dyn ChannelFile,
    settings: Option<&ColumnSettings>,
    linkage: &Linkage,
) -> Result<Table, CampaignError> {
    let own = ColumnSettings::by_own_names();
    let sources = &settings.unwrap_or(&own).sources;
    let time = sources.iter().find(|wanted| wanted.column.name == TIME);
    let lift = sources.iter().find(|wanted| wanted.column.name == LIFT);
    let lift = lift.map_or(Ok(None), |wanted| find(file, wanted))?;
    let mut taken: Vec<(&'static str, Series)> = Vec::new();
    let mut whole_s = f64::INFINITY;
    for wanted in sources.iter().filter(|wanted| wanted.column.name != TIME) {
        if let Some(channel) = find(file, wanted)? {
            let series = scaled_series(file, channel, wanted, (time, lift), linkage)?;
            if file.is_shortened(channel) {
                let last_s = series.times_s.last().copied();
                whole_s = whole_s.min(last_s.unwrap_or(whole_s));
            }
            taken.push((wanted.column.name, series));
        }
    }
    let rows = taken.iter().find(|(name, _)| *name == LIFT);
    let Some((_, rows)) = rows else {
        let (what, hint) = unassigned("channel", &LIFTS);
        return Err(file.source().error(what, hint));
    };
    let source = Arc::new(file.source().clone());
    let series = taken.iter().map(|(name, series)| (*name, 0, series));
    let table = Table::of_series(&source, (0, &rows.until(whole_s)), series, Cells::Nowhere)?;
    Ok(if file.is_cut_off() {
        table.cut_off()
    } else {
        table
    })
}

/// The channels with samples.
#[cfg(feature = "mdf")]
pub fn survey(file: &dyn ChannelFile) -> Vec<LogColumn> {
    let mut columns: Vec<LogColumn> = Vec::new();
    for (index, channel) in file.channels().iter().enumerate() {
        let series = match channel.fault {
            Some(fault) => Err(fault.to_owned()),
            None => file.series(index, None, None).map_err(|fault| fault.what),
        };
        let (series, fault) = match series {
            Ok(series) => (series, None),
            Err(fault) => (Series::default(), Some(fault)),
        };
        if fault.is_some() || !series.values.is_empty() {
            columns.push(LogColumn {
                lasts_s: lasts(&series.times_s),
                values: series.values,
                fault,
                ..LogColumn::new(&channel.name, channel.unit.as_deref())
            });
        }
    }
    columns
}

/// Time from the first sample to the last one, in the unit of the times.
pub fn lasts(times: &[f64]) -> Option<f64> {
    let (first, last) = times.first().zip(times.last())?;
    Some(last - first)
}

/// Index of the channel of a column; `None` if it is missing and optional.
fn find(file: &dyn ChannelFile, wanted: &Source) -> Result<Option<usize>, CampaignError> {
    let channels = file.channels();
    let with = |is_it: &dyn Fn(&str) -> bool| -> Vec<usize> {
        (0..channels.len())
            .filter(|&index| is_it(&channels[index].name))
            .collect()
    };
    let mut named = with(&|name| name == wanted.name);
    if named.is_empty() {
        named = with(&|name| without_group(name) == Some(wanted.name.as_str()));
    }
    match named[..] {
        [channel] => Ok(Some(channel)),
        [] if !wanted.is_required => Ok(None),
        [] => Err(missing(file, wanted)),
        [first, second, ..] => {
            let what = format!(
                "{} channels are named {}, and [columns] does not say which is {}",
                named.len(),
                quote(&wanted.name),
                wanted.column.name
            );
            let [first, second] = [first, second].map(|index| quote(&channels[index].name));
            let hint = if first == second {
                "give them different names, and save the file again".to_owned()
            } else {
                format!("assign {first} or {second}")
            };
            Err(file.source().error(what, hint))
        }
    }
}

/// A channel that does not exist.
pub fn missing(file: &dyn ChannelFile, wanted: &Source) -> CampaignError {
    let channels = file.channels().iter();
    let names: Vec<&str> = channels.map(|channel| channel.name.as_str()).collect();
    let (what, hint) = wanted.missing("channel", &names);
    file.source().error(what, hint)
}

fn scaled_series(
    file: &dyn ChannelFile,
    index: usize,
    wanted: &Source,
    (time, lift): (Option<&Source>, Option<usize>),
    linkage: &Linkage,
) -> Result<Series, CampaignError> {
    let channel = &file.channels()[index];
    let fault = |(what, hint): (String, String)| file.source().error(what, hint);
    if let Some(what) = channel.fault {
        let what = format!("channel {}: {what}", quote(&channel.name));
        return Err(fault((what, "export it as numbers".to_owned())));
    }
    let scale = wanted.scale(channel.unit.as_deref()).map_err(fault)?;
    let mut series = file.series(index, time, lift)?;
    for (value, time_s) in series.values.iter_mut().zip(&series.times_s) {
        if !value.is_finite() {
            *value = f64::NAN;
            continue;
        }
        let scaled = wanted.column.checked(scale.apply(*value, linkage));
        *value = scaled.map_err(|(would_be, range)| {
            let name = quote(&channel.name);
            fault((
                format!("{value} of channel {name} at {time_s:.3} s {would_be}"),
                format!("{range}: check the unit under [columns]"),
            ))
        })?;
    }
    Ok(series)
}
