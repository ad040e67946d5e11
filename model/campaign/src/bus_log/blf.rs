//! Vector's binary log (CANalyzer, CANoe, CANlog, python-can): objects, most of them in compressed containers.
//!
//! ```text
//! LOGG  header size, ..., file size     header of the file
//! LOBJ  header size, version, object size, type, ...   each object; one of type 10 is a container
//! ```
//!
//! The objects of all containers are one sequence: an object may begin in a container and end in the next.
//! Source: the structures of Vector's `binlog_objects.h`, as documented by python-can.

use std::io::Read as _;

use flate2::read::ZlibDecoder;
use hitch_input::file_kind;
use hitch_input::little_endian::{u16_at, u32_at, u64_at};
use hitch_input::source_file::SourceFile;

use crate::bus_log::frame::{Frame, FrameSink, Id, MOST_BYTES};
use crate::bus_log::line::Ending;
use crate::recorded::CampaignError;

/// Begin of an object.
const OBJECT: &[u8] = b"LOBJ";
/// Bytes of the part of the header that all objects have.
const BASE: usize = 16;
/// Objects are padded: the next one begins within so many bytes.
const MOST_PADDING: usize = 8;
/// Largest content of a container, bytes; usual are 128 KiB.
const LARGEST_CONTAINER: u32 = 64 << 20;
/// Bit of an identifier: it has 29 bits.
const IS_EXTENDED: u32 = 1 << 31;
/// Bit of the flags of an object: its time is in tens of microseconds.
const TENS_OF_US: u32 = 1;

/// A fault: what is wrong.
type Fault = String;

/// Passes every data frame that `sink` wants to it.
///
/// # Errors
/// The file cannot be read, is broken, or a frame is not valid.
pub fn read(source: &SourceFile, sink: &mut dyn FrameSink) -> Result<Ending, CampaignError> {
    let bytes = SourceFile::bytes(&source.path)?;
    let fault = |what: Fault| broken(source, what);
    let start = start(&bytes).map_err(fault)?;
    let mut content = Vec::new();
    let mut objects = Objects {
        bytes: &bytes,
        at: start,
    };
    let mut is_empty = true;
    while let Some(object) = objects.next().map_err(fault)? {
        if object.kind != Object::CONTAINER {
            pass(&object, sink, source)?;
            is_empty = false;
            continue;
        }
        unpack(object.body(BASE), &mut content).map_err(fault)?;
        let read = pass_all(&content, sink, source)?;
        is_empty &= read == 0;
        content.drain(..read);
    }
    let cut = objects.cut_container();
    if let Some(container) = cut {
        // Its frames up to the end of the file are whole; the fault is that end.
        let _ = unpack(container, &mut content);
        is_empty &= pass_all(&content, sink, source).is_ok_and(|read| read == 0);
    }
    let is_whole = objects.at >= bytes.len() && content.iter().all(|&byte| byte == 0);
    match cut.is_none() && is_whole {
        true => Ok(Ending::Whole),
        false if is_empty => Err(fault("ends in the middle of an object".to_owned())),
        false => Ok(Ending::CutOff),
    }
}

fn broken(source: &SourceFile, what: Fault) -> CampaignError {
    let hint = "copy or log it again; python -m can.logconvert FILE.blf FILE.asc converts what is readable";
    source.error(what, hint)
}

/// Passes the frames of the content of a container; returns the number of bytes of its complete objects.
fn pass_all(
    content: &[u8],
    sink: &mut dyn FrameSink,
    source: &SourceFile,
) -> Result<usize, CampaignError> {
    let mut objects = Objects {
        bytes: content,
        at: 0,
    };
    while let Some(object) = objects.next().map_err(|what| broken(source, what))? {
        pass(&object, sink, source)?;
    }
    Ok(objects.at)
}

/// Where the objects begin.
fn start(bytes: &[u8]) -> Result<usize, Fault> {
    if !file_kind::is_blf(bytes) {
        return Err("is not a binary log of a CAN bus: it does not begin with LOGG".to_owned());
    }
    // The size that the header states is wrong in a file that was not closed.
    match u32_at(bytes, 4).map(|start| start as usize) {
        Some(start) if start <= bytes.len() => Ok(start),
        _ => Err("ends within its header".to_owned()),
    }
}

/// The objects of a part of the file.
struct Objects<'b> {
    bytes: &'b [u8],
    /// Behind the last complete object.
    at: usize,
}

/// An object with its header.
struct Object<'b> {
    kind: u32,
    bytes: &'b [u8],
}

impl<'b> Objects<'b> {
    /// The whole part of a container that the end of the file cuts off.
    fn cut_container(&self) -> Option<&'b [u8]> {
        let rest = &self.bytes[self.at..];
        let begin = rest.windows(OBJECT.len()).position(|four| four == OBJECT)?;
        let is_container = u32_at(rest, begin + 12) == Some(Object::CONTAINER);
        rest.get(begin + BASE..).filter(|_| is_container)
    }

    /// The next object; `None` if there is no further complete one.
    fn next(&mut self) -> Result<Option<Object<'b>>, Fault> {
        let rest = &self.bytes[self.at..];
        let window = &rest[..rest.len().min(MOST_PADDING + OBJECT.len())];
        let begin = window.windows(OBJECT.len()).position(|four| four == OBJECT);
        let Some(begin) = begin else {
            if rest.len() >= MOST_PADDING + OBJECT.len() {
                return Err(format!(
                    "has no object at byte {} of a container or of the file",
                    self.at
                ));
            }
            if rest.iter().all(|&byte| byte == 0) {
                self.at = self.bytes.len();
            }
            return Ok(None);
        };
        let object = &rest[begin..];
        let Some((size, kind)) = u32_at(object, 8).zip(u32_at(object, 12)) else {
            return Ok(None);
        };
        if (size as usize) < BASE {
            return Err(format!("has an object of {size} bytes"));
        }
        let Some(bytes) = object.get(..size as usize) else {
            return Ok(None);
        };
        self.at += begin + bytes.len();
        Ok(Some(Object { kind, bytes }))
    }
}

/// Adds the content of a container to what is left of the previous one.
fn unpack(container: &[u8], content: &mut Vec<u8>) -> Result<(), Fault> {
    const HEADER: usize = 16;
    const PLAIN: u16 = 0;
    const ZLIB: u16 = 2;
    let header = u16_at(container, 0).zip(u32_at(container, 8));
    let Some(((method, size), packed)) = header.zip(container.get(HEADER..)) else {
        return Err("has a container without a header".to_owned());
    };
    match method {
        PLAIN => content.extend_from_slice(packed),
        ZLIB if size > LARGEST_CONTAINER => {
            return Err(format!("has a container of {size} bytes"));
        }
        ZLIB => {
            let before = content.len();
            let mut unpacked = ZlibDecoder::new(packed).take(u64::from(size) + 1);
            let read = unpacked.read_to_end(content);
            read.map_err(|error| format!("has a container that cannot be unpacked: {error}"))?;
            if content.len() - before != size as usize {
                return Err(format!(
                    "has a container that does not unpack to {size} bytes"
                ));
            }
        }
        other => {
            return Err(format!(
                "has a container of compression {other}; 0 and 2 are known"
            ));
        }
    }
    Ok(())
}

/// The parts of a data frame.
struct Parts<'b> {
    time_s: f64,
    channel: u16,
    id: u32,
    data: &'b [u8],
}

impl<'b> Object<'b> {
    const CONTAINER: u32 = 10;
    const CAN: u32 = 1;
    const CAN_2: u32 = 86;
    const CAN_FD: u32 = 100;
    const CAN_FD_64: u32 = 101;

    /// The bytes behind a header; none if the object is shorter.
    fn body(&self, header: usize) -> &'b [u8] {
        self.bytes.get(header..).unwrap_or_default()
    }

    /// The data frame of an object; `None` for other objects, and for frames that are incomplete.
    fn frame(&self) -> Option<Parts<'b>> {
        let header = match u16_at(self.bytes, 6)? {
            1 => 32,
            2 => 40,
            _ => return None,
        };
        let tick_s = match u32_at(self.bytes, 16)? {
            TENS_OF_US => 1e-5,
            _ => 1e-9,
        };
        let time_s = u64_at(self.bytes, 24)? as f64 * tick_s;
        let body = self.body(header);
        let part = |at: usize| body.get(at).map(|&byte| usize::from(byte));
        let (channel, id) = match self.kind {
            Self::CAN_FD_64 => (u16::from(*body.first()?), u32_at(body, 4)?),
            _ => (u16_at(body, 0)?, u32_at(body, 4)?),
        };
        const REMOTE: usize = 0x80;
        const REMOTE_64: u32 = 0x10;
        const REQUEST: usize = 2;
        let (from, length) = match self.kind {
            Self::CAN | Self::CAN_2 if part(2)? & REMOTE == 0 => (8, part(3)?.min(8)),
            Self::CAN_FD if part(2)? & REMOTE == 0 => (20, part(14)?.min(MOST_BYTES)),
            Self::CAN_FD_64 if u32_at(body, 12)? & REMOTE_64 == 0 && part(34)? != REQUEST => {
                (40, part(2)?.min(MOST_BYTES))
            }
            _ => return None,
        };
        Some(Parts {
            time_s,
            channel,
            id,
            data: body.get(from..from + length)?,
        })
    }
}

/// Passes the frame of an object to a sink, if it has one that is wanted.
fn pass(
    object: &Object<'_>,
    sink: &mut dyn FrameSink,
    source: &SourceFile,
) -> Result<(), CampaignError> {
    let Some(parts) = object.frame() else {
        return Ok(());
    };
    let is_extended = parts.id & IS_EXTENDED != 0;
    let Some(id) = Id::new(parts.id & !IS_EXTENDED, is_extended) else {
        let what = format!(
            "contains the identifier {:#x}, which is too large",
            parts.id
        );
        return Err(source.error(what, "copy or log it again"));
    };
    let channel = parts.channel.to_string();
    if !sink.wants(&channel, id) {
        return Ok(());
    }
    sink.take(&Frame {
        time_s: parts.time_s,
        channel: &channel,
        id,
        data: parts.data,
        byte: 0,
    })
}
