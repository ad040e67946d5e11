//! Frames in MDF 4, as bus loggers write them (CANedge, Vector; ASAM MDF bus logging): a group of frames with their bytes.

use std::path::Path;

use falcon_mdf::Mf4File;
use hitch_input::source_file::SourceFile;
use hitch_mdf_file::Recording;

use crate::bus_log::frame::{Frame, FrameSink, Id};
use crate::bus_log::line::Ending;
use crate::mdf_log::is_mdf;
use crate::recorded::CampaignError;

/// Whether a file contains frames, and no channels beside them.
pub fn is_one(path: &Path) -> bool {
    let Some((file, _)) = is_mdf(path).then(|| open(path).ok()).flatten() else {
        return false;
    };
    let frames = file.can_frame_groups().into_iter();
    let frames: Vec<_> = frames.map(std::ptr::from_ref).collect();
    let groups = file
        .data_groups()
        .iter()
        .flat_map(|data| &data.channel_groups);
    let mut filled = groups.filter(|group| group.sample_count > 0 && !group.is_vlsd());
    let is_frames = |group| frames.contains(&std::ptr::from_ref(group));
    !frames.is_empty() && filled.all(|group| group.is_bus_event() || is_frames(group))
}

fn open(path: &Path) -> falcon_mdf::Result<(Mf4File, Ending)> {
    let recording = Recording::open(path, true)?;
    let ending = if recording.is_cut_off {
        Ending::CutOff
    } else {
        Ending::Whole
    };
    Ok((Mf4File::from_source(recording)?, ending))
}

/// Passes every data frame that `sink` wants to it, in the order of time.
///
/// # Errors
/// The file cannot be read.
pub fn read(source: &SourceFile, sink: &mut dyn FrameSink) -> Result<Ending, CampaignError> {
    let fault = |error: falcon_mdf::Mf4Error| {
        let hint = "export it as .asc or .blf with the logger's tool";
        source.error(format!("cannot be read as MDF: {error}"), hint)
    };
    let (file, ending) = open(&source.path).map_err(fault)?;
    let mut groups = Vec::new();
    for group in file.can_frame_groups() {
        groups.push(file.can_frames(group).map_err(fault)?);
    }
    let mut frames: Vec<_> = groups.iter().flat_map(|group| group.iter()).collect();
    frames.sort_by(|a, b| a.timestamp.total_cmp(&b.timestamp));
    for frame in frames {
        // A file that does not state the kind of an identifier has one of 11 bits if it fits into them.
        let kind = frame.extended;
        let is_extended = kind.unwrap_or_else(|| Id::new(frame.id, false).is_none());
        let channel = frame.bus_channel.to_string();
        let Some(id) = Id::new(frame.id, is_extended).filter(|id| sink.wants(&channel, *id)) else {
            continue;
        };
        if !frame.timestamp.is_finite() {
            let hint = "export it again with time stamps";
            return Err(source.error("has a frame without a time", hint));
        }
        sink.take(&Frame {
            time_s: frame.timestamp,
            channel: &channel,
            id,
            data: frame.data,
            byte: 0,
        })?;
    }
    Ok(ending)
}
