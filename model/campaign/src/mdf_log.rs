//! Logs of measurement tools in MDF, versions 3 and 4 (ASAM): CANape, INCA, CANedge, asammdf and others.

use std::collections::{HashMap, HashSet};
use std::path::Path;
use std::sync::Arc;

use falcon_mdf::mdf3::Mdf3File;
use falcon_mdf::{Channel, Mf4File};
use hitch_input::file_kind::{self, first_bytes};
use hitch_input::input_error::{InputError, quote};
use hitch_input::source_file::SourceFile;
use hitch_mdf_file::{Recording, unit_of_conversion};

use crate::channel_log::{ChannelFile, LogChannel};
use crate::columns::Source;
use crate::contents::OF_GROUP;
use crate::recorded::CampaignError;
use crate::series::Series;
use crate::time_base::unit_size_s;

/// Byte offset of the version in a file.
const VERSION: std::ops::Range<usize> = 8..16;

/// Whether a file is MDF, by its first bytes or its name.
pub fn is_mdf(path: &Path) -> bool {
    let end = path.extension().and_then(|end| end.to_str());
    let is_named =
        end.is_some_and(|end| ["mf4", "mdf", "dat"].contains(&&*end.to_ascii_lowercase()));
    is_named && first_bytes(path).is_some_and(|bytes| file_kind::is_mdf(&bytes))
}

/// An open file.
pub struct MdfFile {
    source: SourceFile,
    reader: Reader,
    recording: Arc<Recording>,
    /// Its channels other than times.
    channels: Vec<LogChannel>,
    /// Data group, channel group and index in it, of each channel.
    places: Vec<[usize; 3]>,
}

enum Reader {
    V4(Box<Mf4File>),
    V3(Box<Mdf3File>),
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
        let recording = Recording::open(path, is_v4).map_err(fault)?;
        let (reader, placed) = if is_v4 {
            let file = Mf4File::from_source(recording.clone()).map_err(fault)?;
            let placed = channels_of_v4(&file, &recording);
            (Reader::V4(Box::new(file)), placed)
        } else {
            let file = Mdf3File::from_source(recording.clone()).map_err(fault)?;
            let placed = channels_of_v3(&file, &recording);
            (Reader::V3(Box::new(file)), placed)
        };
        let (channels, places) = tell_apart(placed).into_iter().unzip();
        Ok(Self {
            source,
            reader,
            recording,
            channels,
            places,
        })
    }
}

impl ChannelFile for MdfFile {
    fn source(&self) -> &SourceFile {
        &self.source
    }

    fn channels(&self) -> &[LogChannel] {
        &self.channels
    }

    fn is_cut_off(&self) -> bool {
        self.recording.is_cut_off
    }

    fn is_shortened(&self, channel: usize) -> bool {
        self.recording.shortened.contains(&self.places[channel][0])
    }

    /// The samples of a channel; NaN where marked as invalid.
    fn series(
        &self,
        channel: usize,
        _time: Option<&Source>,
        _lift: Option<usize>,
    ) -> Result<Series, CampaignError> {
        let name = &self.channels[channel].name;
        let fault = |error| unreadable(&self.source, name, &error);
        let [data_group, group, index] = self.places[channel];
        let (times_s, values) = match &self.reader {
            Reader::V4(file) => {
                let channels = &file.data_groups()[data_group].channel_groups[group].channels;
                samples_of_v4(file, &channels[index]).map_err(fault)?
            }
            Reader::V3(file) => {
                let channels = &file.data_groups()[data_group].channel_groups[group].channels;
                let read = |index| {
                    let values = file.channel_physical(data_group, group, index);
                    values.map(|values| values.to_f64()).map_err(fault)
                };
                let times = channels.iter().position(|channel| channel.is_time());
                let times_s = times.map_or(Ok(Vec::new()), |times| {
                    Ok(in_seconds(read(times)?, &channels[times].unit))
                });
                (times_s?, read(index)?)
            }
        };
        if times_s.len() != values.len() {
            let what = format!("channel {} has no time stamps", quote(name));
            let hint = "export it together with the time channel of its group";
            return Err(self.source.error(what, hint));
        }
        let bytes = vec![0; values.len()];
        Ok(Series {
            times_s,
            values,
            bytes,
        })
    }
}

/// A channel, its position (data group, channel group, channel), and the names of its group.
struct Placed {
    channel: LogChannel,
    place: [usize; 3],
    labels: [String; 3],
}

/// Why a channel without samples cannot be used; `None` if it only was not sent.
fn lost(samples: u64, recording: &Recording) -> Option<&'static str> {
    let is_lost = samples == 0 && recording.is_cut_off;
    is_lost.then_some("the file is cut off before its samples")
}

fn channels_of_v4(file: &Mf4File, recording: &Recording) -> Vec<Placed> {
    let mut channels = Vec::new();
    let mut number = 0;
    for (data_group, data) in file.data_groups().iter().enumerate() {
        for (group_index, group) in data.channel_groups.iter().enumerate() {
            number += 1;
            for (index, channel) in group.channels.iter().enumerate() {
                if channel.is_master() {
                    continue;
                }
                let found = LogChannel {
                    name: channel.name.clone(),
                    unit: unit(&channel.unit).or_else(|| unit_of_conversion(recording, channel)),
                    samples: group.sample_count as usize,
                    fault: match channel.value_kind().is_numeric() {
                        false => Some("it has texts, or values converted to texts"),
                        true if channel.is_array() => Some("it has arrays"),
                        true => lost(group.sample_count, recording),
                    },
                };
                let source = channel.source.as_ref().or(group.source.as_ref());
                let source = source.map(|source| match source.name.trim() {
                    "" => source.path.clone(),
                    name => name.to_owned(),
                });
                channels.push(Placed {
                    channel: found,
                    place: [data_group, group_index, index],
                    labels: [
                        group.acquisition_name.clone(),
                        source.unwrap_or_default(),
                        format!("group {number}"),
                    ],
                });
            }
        }
    }
    channels
}

fn channels_of_v3(file: &Mdf3File, recording: &Recording) -> Vec<Placed> {
    let mut channels = Vec::new();
    let mut number = 0;
    for (data_group, data) in file.data_groups().iter().enumerate() {
        for (group_index, group) in data.channel_groups.iter().enumerate() {
            number += 1;
            for (index, channel) in group.channels.iter().enumerate() {
                if channel.is_time() {
                    continue;
                }
                let comment = group.comment.lines().next().unwrap_or_default();
                channels.push(Placed {
                    channel: LogChannel {
                        name: channel.name.clone(),
                        unit: unit(&channel.unit),
                        samples: group.cycle_count as usize,
                        fault: lost(group.cycle_count.into(), recording),
                    },
                    place: [data_group, group_index, index],
                    labels: [comment.to_owned(), String::new(), format!("group {number}")],
                });
            }
        }
    }
    channels
}

fn unit(text: &str) -> Option<String> {
    let text = text.trim();
    (!text.is_empty()).then(|| text.to_owned())
}

/// Adds the group to the names that occur several times. Tools create groups without samples for signals that were not
/// sent: these are left out.
fn tell_apart(placed: Vec<Placed>) -> Vec<(LogChannel, [usize; 3])> {
    let mut equals: HashMap<String, Vec<usize>> = HashMap::new();
    for (index, found) in placed.iter().enumerate() {
        let named = equals.entry(found.channel.name.clone()).or_default();
        named.push(index);
    }
    let mut names: Vec<Option<String>> = vec![None; placed.len()];
    for (name, mut indices) in equals {
        if indices
            .iter()
            .any(|&index| placed[index].channel.samples > 0)
        {
            indices.retain(|&index| placed[index].channel.samples > 0);
        }
        if let [only] = indices[..] {
            names[only] = Some(name);
            continue;
        }
        let label = |index: usize, kind: usize| {
            let words = placed[index].labels[kind].split_whitespace();
            words.collect::<Vec<_>>().join(" ")
        };
        let tells = |kind: &usize| {
            let labels: HashSet<String> = indices.iter().map(|&i| label(i, *kind)).collect();
            labels.len() == indices.len() && !labels.contains("")
        };
        let kind = (0..3).find(tells);
        for (count, &index) in indices.iter().enumerate() {
            let label = match kind {
                Some(kind) => label(index, kind),
                None => format!("{} #{}", label(index, 2), count + 1),
            };
            names[index] = Some(format!("{name}{OF_GROUP}{label}"));
        }
    }
    let named = placed.into_iter().zip(names);
    let named = named.filter_map(|(found, name)| {
        let name = name?;
        let channel = LogChannel {
            name,
            ..found.channel
        };
        Some((channel, found.place))
    });
    named.collect()
}

fn samples_of_v4(file: &Mf4File, channel: &Channel) -> falcon_mdf::Result<(Vec<f64>, Vec<f64>)> {
    let group =
        &file.data_groups()[channel.data_group_index].channel_groups[channel.channel_group_index];
    let Some(times) = group
        .master_channel()
        .filter(|times| times.is_time_channel())
    else {
        return Ok((Vec::new(), file.signal(channel)?.values_f64()?));
    };
    // The library refuses times that are set back, at which a log is split.
    let logged = file.channel_timestamps(channel);
    let logged = logged.or_else(|_| file.signal(times)?.values_f64())?;
    let times_s = in_seconds(logged, &times.unit);
    let signal = file.signal(channel)?;
    let mut values = signal.values_f64()?;
    for (value, is_valid) in values.iter_mut().zip(signal.validity().unwrap_or_default()) {
        if !is_valid {
            *value = f64::NAN;
        }
    }
    Ok((times_s, values))
}

/// Times that state another unit, though the standard demands seconds.
fn in_seconds(mut times: Vec<f64>, unit: &str) -> Vec<f64> {
    let size_s = unit_size_s(unit);
    times.iter_mut().for_each(|time| *time *= size_s);
    times
}

fn unreadable(source: &SourceFile, channel: &str, error: &falcon_mdf::Mf4Error) -> InputError {
    let which = match channel {
        "" => String::new(),
        name => format!("channel {} of it: ", quote(name)),
    };
    let hint = "export it again, as MDF 4.1 without encryption, or as CSV";
    source.error(format!("cannot be read as MDF: {which}{error}"), hint)
}
