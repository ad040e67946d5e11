//! Vector's ASCII log (CANalyzer, CANoe and others, python-can).
//!
//! ```text
//! date Sat Nov 21 10:00:00.000 am 2026
//! base hex  timestamps absolute
//! Begin Triggerblock Sat Nov 21 10:00:00.000 am 2026
//!  0.000000 Start of measurement
//!  0.012300 1  18FF4580x       Rx   d 8 00 11 22 33 44 55 66 77  Length = 240000 BitCount = 124
//!  0.013300 CANFD   1 Rx   18FF4580x   [name]   1 0 8  8 00 11 22 33 44 55 66 77 ...
//!  0.020000 1  Statistic: D 2 R 0 XD 0 XR 0 E 0 O 0 B 0.00%
//! End TriggerBlock
//! ```
//!
//! Frames that are needed are parsed completely, others up to the identifier; other events of the bus, and events of
//! other buses, are skipped.

use hitch_input::source_file::SourceFile;

use crate::bus_log::frame::{Frame, FrameSink, Id, MOST_BYTES};
use crate::bus_log::line::{Ending, Line, Word, each_line};
use crate::recorded::CampaignError;

/// First words of lines that contain no event.
const HEADINGS: [&str; 7] = ["date", "base", "internal", "no", "Begin", "End", "previous"];
/// Events of a CAN channel other than frames.
const OTHER_EVENTS: [&str; 4] = ["ErrorFrame", "OverloadFrame", "Statistic:", "J1939TP"];
/// Data bytes of a classical frame.
const MOST_CLASSICAL: usize = 8;
/// Largest data length code.
const MOST_CODE: usize = 15;

/// Number base and time mode of the log.
#[derive(Debug, Clone, Copy)]
struct Notation {
    radix: u32,
    /// Time stamps are relative to the previous event instead of the start.
    relative: bool,
}

/// Passes every data frame that `sink` wants to it.
pub fn read(source: &SourceFile, sink: &mut dyn FrameSink) -> Result<Ending, CampaignError> {
    let mut notation = Notation {
        radix: 16,
        relative: false,
    };
    let mut last_s = 0.0;
    let mut bytes = [0; MOST_BYTES];
    each_line(source, |line| {
        let first = line.text(0);
        if first == "base" {
            notation = of_heading(line)?;
        }
        if HEADINGS.contains(&first) || first.starts_with("//") {
            return Ok(());
        }
        let time = line.word(0, "time")?;
        let mut time_s = line.time_s(time, time.text)?;
        if notation.relative {
            time_s += last_s;
        }
        last_s = time_s;
        let length = match line.text(1) {
            "CANFD" => flexible(line, sink, &mut bytes)?,
            channel if channel.bytes().all(|byte| byte.is_ascii_digit()) => {
                classical(line, sink, notation.radix, &mut bytes)?
            }
            _ => None,
        };
        match length {
            Some((channel, id, length)) => sink.take(&Frame {
                time_s,
                channel,
                id,
                data: &bytes[..length],
                byte: line.byte(),
            }),
            None => Ok(()),
        }
    })
}

/// `base hex  timestamps absolute`
fn of_heading(line: &Line<'_>) -> Result<Notation, CampaignError> {
    let hint = "write: base hex timestamps absolute";
    let base = line.word(1, "base")?;
    let radix = match base.text {
        "hex" => 16,
        "dec" => 10,
        _ => return Err(line.fault(base, 0, "is not a base", hint)),
    };
    let relative = match line.text(3) {
        "" | "absolute" => false,
        "relative" => true,
        _ => {
            let kind = line.word(3, "kind of time stamp")?;
            return Err(line.fault(kind, 0, "is not a kind of time stamp", hint));
        }
    };
    Ok(Notation { radix, relative })
}

/// Channel, identifier and number of bytes of a frame.
type Parts<'a> = Option<(&'a str, Id, usize)>;

/// `TIME CHANNEL ID Rx|Tx d LENGTH DATA...`
fn classical<'a>(
    line: &Line<'a>,
    sink: &mut dyn FrameSink,
    radix: u32,
    bytes: &mut [u8],
) -> Result<Parts<'a>, CampaignError> {
    let id = line.word(2, "identifier")?;
    if OTHER_EVENTS.contains(&id.text) {
        return Ok(None);
    }
    let was_sent = direction(line, line.word(3, "direction")?)?;
    let id = identifier(line, id, radix)?;
    let kind = line.word(4, "kind of frame")?;
    match kind.text {
        "d" if was_sent => {}
        "d" | "r" => return Ok(None),
        _ => return Err(line.fault(kind, 0, "is not a kind of frame", "use d or r")),
    }
    if !sink.wants(line.text(1), id) {
        return Ok(None);
    }
    let count = line.word(5, "length")?;
    let length = number(line, count, radix, MOST_BYTES as u32)? as usize;
    // Up to 15 it is a data length code as in classical frames; some tools write it for CAN FD as well.
    let is_flexible = length > MOST_CODE;
    let length = if is_flexible {
        length
    } else {
        length.min(MOST_CLASSICAL)
    };
    data(line, 6, radix, &mut bytes[..length])?;
    Ok(Some((line.text(1), id, length)))
}

/// `TIME CANFD CHANNEL Rx|Tx ID [NAME] BRS ESI DLC LENGTH DATA...`
fn flexible<'a>(
    line: &Line<'a>,
    sink: &mut dyn FrameSink,
    bytes: &mut [u8],
) -> Result<Parts<'a>, CampaignError> {
    let channel = line.word(2, "channel")?;
    let was_sent = direction(line, line.word(3, "direction")?)?;
    let id = line.word(4, "identifier")?;
    if !was_sent || OTHER_EVENTS.contains(&id.text) {
        return Ok(None);
    }
    let id = identifier(line, id, 16)?;
    if !sink.wants(channel.text, id) {
        return Ok(None);
    }
    let is_named = !matches!(line.text(5), "0" | "1");
    let count = 8 + usize::from(is_named);
    let word = line.word(count, "length")?;
    let length = number(line, word, 10, MOST_BYTES as u32)? as usize;
    data(line, count + 1, 16, &mut bytes[..length])?;
    Ok(Some((channel.text, id, length)))
}

/// Whether the frame was on the bus; false for a transmit request.
fn direction(line: &Line<'_>, word: Word<'_>) -> Result<bool, CampaignError> {
    match word.text {
        "Rx" | "Tx" => Ok(true),
        "TxRq" => Ok(false),
        _ => Err(line.fault(word, 0, "is not a direction", "use Rx or Tx")),
    }
}

fn identifier(line: &Line<'_>, word: Word<'_>, radix: u32) -> Result<Id, CampaignError> {
    let hint = "log identifiers as numbers; those of 29 bits have the suffix x";
    let digits = word.text.strip_suffix('x');
    let raw = digits_of(digits.unwrap_or(word.text), radix);
    raw.and_then(|raw| Id::new(raw, digits.is_some()))
        .ok_or_else(|| line.fault(word, 0, "is not an identifier", hint))
}

fn number(line: &Line<'_>, word: Word<'_>, radix: u32, largest: u32) -> Result<u32, CampaignError> {
    let value = digits_of(word.text, radix).filter(|&value| value <= largest);
    value.ok_or_else(|| {
        let hint = format!("the range is 0 to {largest}, in base {radix}");
        line.fault(word, 0, "is not a number of the required range", &hint)
    })
}

fn data(line: &Line<'_>, first: usize, radix: u32, bytes: &mut [u8]) -> Result<(), CampaignError> {
    for (index, byte) in bytes.iter_mut().enumerate() {
        let word = line.word(first + index, "last byte")?;
        // It is at most 255.
        *byte = number(line, word, radix, 255)? as u8;
    }
    Ok(())
}

/// A number that consists of digits only, without a sign.
fn digits_of(text: &str, radix: u32) -> Option<u32> {
    let all = text.chars().all(|digit| digit.is_digit(radix));
    u32::from_str_radix(text, radix).ok().filter(|_| all)
}
