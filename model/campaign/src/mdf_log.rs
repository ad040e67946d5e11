//! Logs of measurement tools in MDF, versions 3 and 4 (ASAM): CANape, INCA, CANedge, asammdf and others.
//!
//! A row is a sample of the lift current; other channels are moved to its times, as in bus logs.

use std::fs::File;
use std::io::Read as _;
use std::path::Path;
use std::sync::Arc;

use falcon_mdf::mdf3::Mdf3File;
use falcon_mdf::{Channel, Mf4File};
use hitch_input::file_kind;
use hitch_input::input_error::{InputError, quote};
use hitch_input::source_file::SourceFile;
use hitch_plant::Linkage;

use crate::CampaignError;
use crate::columns::{ColumnSettings, Source, offer_columns};
use crate::scale::Scale;
use crate::series::{Series, values};
use crate::table::{Cells, Column, LIFT, Samples, TIME, Table};

/// Byte offset of the version in a file.
const VERSION: std::ops::Range<usize> = 8..16;

/// Whether a file is MDF, by its first bytes or its name.
pub fn is_mdf(path: &Path) -> bool {
    let end = path.extension().and_then(|end| end.to_str());
    let is_named =
        end.is_some_and(|end| ["mf4", "mdf", "dat"].contains(&&*end.to_ascii_lowercase()));
    is_named && first_bytes(path).is_some_and(|bytes| file_kind::is_mdf(&bytes))
}

fn first_bytes(path: &Path) -> Option<[u8; 16]> {
    let mut bytes = [0; 16];
    let mut file = File::open(path).ok()?;
    file.read_exact(&mut bytes).ok()?;
    Some(bytes)
}

/// A channel and its position.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MdfChannel {
    /// Its name.
    pub name: String,
    /// Its unit; `None` without one.
    pub unit: Option<String>,
    /// Number of samples.
    pub samples: usize,
    /// Data group, channel group and index in it.
    place: [usize; 3],
}

/// An open file.
#[derive(Debug)]
pub struct MdfFile {
    source: SourceFile,
    reader: Reader,
    /// Its channels other than times.
    pub channels: Vec<MdfChannel>,
}

enum Reader {
    V4(Box<Mf4File>),
    V3(Box<Mdf3File>),
}

impl std::fmt::Debug for Reader {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::V4(_) => "MDF 4",
            Self::V3(_) => "MDF 3",
        })
    }
}

impl MdfFile {
    /// Opens a file.
    ///
    /// # Errors
    /// The file cannot be read.
    pub fn open(path: &Path) -> Result<Self, CampaignError> {
        let source = SourceFile::named(path);
        let version = first_bytes(path).unwrap_or_default();
        let is_v4 = version[VERSION].starts_with(b"4");
        let fault = |error: falcon_mdf::Mf4Error| unreadable(&source, "", &error);
        let (reader, channels) = if is_v4 {
            let file = Mf4File::open(path).map_err(fault)?;
            let channels = channels_of_v4(&file);
            (Reader::V4(Box::new(file)), channels)
        } else {
            let file = Mdf3File::open(path).map_err(fault)?;
            let channels = channels_of_v3(&file);
            (Reader::V3(Box::new(file)), channels)
        };
        Ok(Self {
            source,
            reader,
            channels,
        })
    }

    /// The samples of a channel; NaN where marked as invalid.
    ///
    /// # Errors
    /// The samples cannot be read.
    pub fn series(&self, channel: &MdfChannel) -> Result<Series, CampaignError> {
        let fault = |error| unreadable(&self.source, &channel.name, &error);
        let [data_group, group, index] = channel.place;
        let (times_s, values) = match &self.reader {
            Reader::V4(file) => {
                let place = file.data_groups().get(data_group);
                let group = place.and_then(|place| place.channel_groups.get(group));
                let found = group.and_then(|group| group.channels.get(index));
                let Some(found) = found else {
                    return Ok(Series::default());
                };
                samples_of_v4(file, found).map_err(fault)?
            }
            Reader::V3(file) => {
                let groups = &file.data_groups()[data_group].channel_groups;
                let times = groups[group]
                    .channels
                    .iter()
                    .position(|channel| channel.is_time());
                let values = file
                    .channel_physical(data_group, group, index)
                    .map_err(fault)?;
                let times_s = match times {
                    Some(times) => file
                        .channel_physical(data_group, group, times)
                        .map_err(fault)?
                        .to_f64(),
                    None => Vec::new(),
                };
                (times_s, values.to_f64())
            }
        };
        if times_s.len() != values.len() {
            let what = format!("channel {} has no time stamps", quote(&channel.name));
            let mend = "export it together with the time channel of its group";
            return Err(self.source.error(what, mend));
        }
        let bytes = vec![0; values.len()];
        Ok(Series {
            times_s,
            values,
            bytes,
        })
    }

    /// The channel of a column; `None` if it is missing and optional.
    fn find(&self, wanted: &Source) -> Result<Option<&MdfChannel>, CampaignError> {
        let named = self
            .channels
            .iter()
            .filter(|channel| channel.name == wanted.name);
        // Tools create groups without samples for signals that were not sent.
        match named.max_by_key(|channel| channel.samples) {
            Some(channel) => Ok(Some(channel)),
            None if !wanted.is_required => Ok(None),
            None => {
                let names: Vec<&str> = self
                    .channels
                    .iter()
                    .map(|channel| channel.name.as_str())
                    .collect();
                let what = format!(
                    "channel {} does not exist; [columns] assigns it to {}",
                    quote(&wanted.name),
                    wanted.column.name
                );
                Err(self.source.error(what, offer_columns(&wanted.name, &names)))
            }
        }
    }

    fn taken(
        &self,
        wanted: &Source,
        channel: &MdfChannel,
        linkage: &Linkage,
    ) -> Result<Series, CampaignError> {
        let fault = |(what, mend): (String, String)| self.source.error(what, mend);
        let scale = wanted.scale(channel.unit.as_deref()).map_err(fault)?;
        let mut series = self.series(channel)?;
        for index in 0..series.values.len() {
            let value = scaled(scale, linkage, series.values[index], wanted.column);
            series.values[index] = value.map_err(|value| {
                let what = format!(
                    "{} of channel {} at {:.3} s would be {} = {value}",
                    series.values[index],
                    quote(&channel.name),
                    series.times_s[index],
                    wanted.column.name
                );
                let (low, high) = (wanted.column.range.start(), wanted.column.range.end());
                let mend = format!("the range is {low} to {high}: check the unit under [columns]");
                self.source.error(what, mend)
            })?;
        }
        Ok(series)
    }
}

/// The value in the column's unit; NaN is kept.
///
/// # Errors
/// The value, if it is out of the column's range.
fn scaled(scale: Scale, linkage: &Linkage, value: f64, column: &Column) -> Result<f64, f64> {
    if !value.is_finite() {
        return Ok(f64::NAN);
    }
    let value = scale.apply(value, linkage);
    column.range.contains(&value).then_some(value).ok_or(value)
}

/// Reads a log for a hitch with this linkage.
///
/// # Errors
/// The first fault.
pub fn read(
    path: &Path,
    settings: Option<&ColumnSettings>,
    linkage: &Linkage,
) -> Result<Table, CampaignError> {
    let file = MdfFile::open(path)?;
    let own = ColumnSettings::by_own_names();
    let mut taken: Vec<(&'static str, Series)> = Vec::new();
    for wanted in &settings.unwrap_or(&own).sources {
        if wanted.column.name == TIME {
            continue;
        }
        if let Some(channel) = file.find(wanted)? {
            taken.push((wanted.column.name, file.taken(wanted, channel, linkage)?));
        }
    }
    let rows = taken.iter().find(|(name, _)| *name == LIFT);
    let Some((_, rows)) = rows else {
        let what = format!("no channel is assigned to {LIFT}");
        let mend = format!("assign it under [columns]: {LIFT} = \"Name:A\"");
        return Err(file.source.error(what, mend));
    };
    let (times_s, within_s) = (rows.times_s.clone(), rows.median_step_s() / 2.0);
    let samples = |name, values| Samples {
        name,
        cell: 0,
        values,
    };
    let mut columns = vec![samples(TIME, times_s.clone())];
    columns.extend(
        taken
            .iter()
            .map(|(name, series)| samples(name, values(name, series, &times_s, within_s))),
    );
    let bytes = vec![0; times_s.len()];
    Table::new(Arc::new(file.source), columns, bytes, Cells::Nowhere)
}

fn channels_of_v4(file: &Mf4File) -> Vec<MdfChannel> {
    let mut channels = Vec::new();
    for (data_group, data) in file.data_groups().iter().enumerate() {
        for (group_index, group) in data.channel_groups.iter().enumerate() {
            for (index, channel) in group.channels.iter().enumerate() {
                if channel.is_master() || !channel.value_kind().is_numeric() || channel.is_array() {
                    continue;
                }
                channels.push(MdfChannel {
                    name: channel.name.clone(),
                    unit: unit(&channel.unit),
                    samples: group.sample_count as usize,
                    place: [data_group, group_index, index],
                });
            }
        }
    }
    channels
}

fn channels_of_v3(file: &Mdf3File) -> Vec<MdfChannel> {
    let mut channels = Vec::new();
    for (data_group, data) in file.data_groups().iter().enumerate() {
        for (group_index, group) in data.channel_groups.iter().enumerate() {
            let measured = group.channels.iter().enumerate();
            channels.extend(measured.filter(|(_, channel)| !channel.is_time()).map(
                |(index, channel)| MdfChannel {
                    name: channel.name.clone(),
                    unit: unit(&channel.unit),
                    samples: group.cycle_count as usize,
                    place: [data_group, group_index, index],
                },
            ));
        }
    }
    channels
}

fn unit(text: &str) -> Option<String> {
    let text = text.trim();
    (!text.is_empty()).then(|| text.to_owned())
}

fn samples_of_v4(file: &Mf4File, channel: &Channel) -> falcon_mdf::Result<(Vec<f64>, Vec<f64>)> {
    let group =
        &file.data_groups()[channel.data_group_index].channel_groups[channel.channel_group_index];
    if !group.master_channel().is_some_and(Channel::is_time_channel) {
        return Ok((Vec::new(), file.signal(channel)?.values_f64()?));
    }
    let times_s = file.channel_timestamps(channel)?;
    let signal = file.signal(channel)?;
    let mut values = signal.values_f64()?;
    for (value, is_valid) in values.iter_mut().zip(signal.validity().unwrap_or_default()) {
        if !is_valid {
            *value = f64::NAN;
        }
    }
    Ok((times_s, values))
}

fn unreadable(source: &SourceFile, channel: &str, error: &falcon_mdf::Mf4Error) -> InputError {
    let which = match channel {
        "" => String::new(),
        name => format!("channel {} of it: ", quote(name)),
    };
    let mend = "export it again, as MDF 4.1 without encryption, or as CSV";
    source.error(format!("cannot be read as MDF: {which}{error}"), mend)
}
