//! The log format of candump (`candump -l`, can-utils), also written by python-can and SavvyCAN.
//!
//! ```text
//! (1436509052.249713) can0 18FF4580#0011223344556677     a frame of 29 bits; three digits are one of 11 bits
//! (1436509052.250713) can0 123#R                         a remote frame: no data
//! (1436509052.251713) can0 18FF4580##1001122             CAN FD: a digit of flags before the data
//! (1436509052.252713) can0 20000004#0000000000000000     an error frame: more than 29 bits
//! ```
//!
//! An optional last word gives the direction of the frame (`R`, `T`). Of frames that are not needed only the identifier
//! is parsed.

use hitch_input::source_file::SourceFile;

use crate::bus_log::frame::{Frame, FrameSink, Id, MOST_BYTES};
use crate::bus_log::line::{Ending, Line, Word, each_line};
use crate::recorded::CampaignError;

/// Digits of an identifier of 11 bits, and of 29.
const STANDARD_DIGITS: usize = 3;
const EXTENDED_DIGITS: usize = 8;
/// Bytes of a classical frame.
const MOST_CLASSICAL: usize = 8;

/// Passes every data frame that `sink` wants to it.
pub fn read(source: &SourceFile, sink: &mut dyn FrameSink) -> Result<Ending, CampaignError> {
    let mut bytes = [0; MOST_BYTES];
    each_line(source, |line| match frame(line, sink, &mut bytes)? {
        Some(frame) => sink.take(&frame),
        None => Ok(()),
    })
}

/// The frame of a line; `None` if it contains no data or is not wanted.
fn frame<'f>(
    line: &Line<'f>,
    sink: &mut dyn FrameSink,
    bytes: &'f mut [u8; MOST_BYTES],
) -> Result<Option<Frame<'f>>, CampaignError> {
    let time = line.word(0, "time")?;
    let inside = time
        .text
        .strip_prefix('(')
        .and_then(|text| text.strip_suffix(')'));
    let Some(inside) = inside else {
        let hint = "a line has the form (SECONDS) BUS ID#DATA, as written by `candump -l`";
        return Err(line.fault(time, 0, "is not a time in parentheses", hint));
    };
    let time_s = line.time_s(time, inside)?;
    let channel = line.word(1, "bus")?.text;
    let word = line.word(2, "frame")?;
    let Some((id, data)) = word.text.split_once('#') else {
        let hint = "a frame has the form ID#DATA, as written by `candump -l`";
        return Err(line.fault(word, 0, "is not a frame", hint));
    };
    let Some(id) = identifier(line, word, id)? else {
        return Ok(None);
    };
    if data.starts_with('R') || !sink.wants(channel, id) {
        return Ok(None);
    }
    if let Some(more) = line.get(3)
        && (!matches!(more.text, "R" | "T") || line.len() > 4)
    {
        return Err(line.fault(more, 0, "follows the frame", "delete it"));
    }
    let (data, most, begins) = match data.strip_prefix('#') {
        Some(flexible) => match flexible.chars().next() {
            Some(flags) if flags.is_ascii_hexdigit() => (&flexible[1..], MOST_BYTES, 3),
            _ => return Err(line.fault(word, 0, "has no flags", "CAN FD is ID##FLAGS-DATA")),
        },
        None => (data, MOST_CLASSICAL, 1),
    };
    let begins = begins + word.text.find('#').unwrap_or(0);
    let length = decoded(line, word, begins, data, &mut bytes[..most])?;
    Ok(Some(Frame {
        time_s,
        channel,
        id,
        data: &bytes[..length],
        byte: line.byte(),
    }))
}

/// The identifier; `None` for an error frame.
fn identifier(line: &Line<'_>, word: Word<'_>, text: &str) -> Result<Option<Id>, CampaignError> {
    let hint = "an identifier has three or eight hexadecimal digits";
    let is_hex = text.bytes().all(|byte| byte.is_ascii_hexdigit());
    let raw = u32::from_str_radix(text, 16).ok().filter(|_| is_hex);
    match (raw, text.len()) {
        (Some(raw), STANDARD_DIGITS) if Id::new(raw, false).is_none() => {
            Err(line.fault(word, 0, "has more than 11 bits", hint))
        }
        (Some(raw), STANDARD_DIGITS) => Ok(Id::new(raw, false)),
        (Some(raw), EXTENDED_DIGITS) => Ok(Id::new(raw, true)),
        _ => Err(line.fault(word, 0, "has no identifier", hint)),
    }
}

/// Parses two hexadecimal digits per byte, from byte `begins` of the word on; returns the number of bytes.
fn decoded(
    line: &Line<'_>,
    word: Word<'_>,
    begins: usize,
    data: &str,
    bytes: &mut [u8],
) -> Result<usize, CampaignError> {
    let hint = "each data byte has two hexadecimal digits; delete the line if it is truncated";
    let mut length = 0;
    for (index, pair) in data.as_bytes().chunks(2).enumerate() {
        let digits = std::str::from_utf8(pair).unwrap_or_default();
        let is_hex = pair.len() == 2 && pair.iter().all(u8::is_ascii_hexdigit);
        let value = u8::from_str_radix(digits, 16).ok().filter(|_| is_hex);
        match (value, bytes.get_mut(index)) {
            (Some(value), Some(byte)) => *byte = value,
            (None, _) => return Err(line.fault(word, begins + 2 * index, "has bad data", hint)),
            (_, None) => {
                return Err(line.fault(word, begins + 2 * index, "has too many data bytes", hint));
            }
        }
        length = index + 1;
    }
    Ok(length)
}
