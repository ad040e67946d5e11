//! Tables of frames: CANedge, SavvyCAN and python-can write them as CSV.
//!
//! ```text
//! TimestampEpoch;BusChannel;ID;IDE;DLC;DataLength;Dir;EDL;BRS;DataBytes   CANedge: hexadecimal
//! Time Stamp,ID,Extended,Dir,Bus,LEN,D1,D2,D3,D4,D5,D6,D7,D8              SavvyCAN: time in us
//! timestamp,arbitration_id,extended,remote,error,dlc,data                 python-can: data in base64
//! ```

use csv::StringRecord;
use hitch_input::input_error::quote;
use hitch_input::source_file::SourceFile;

use crate::bus_log::frame::{Frame, FrameSink, Id, MOST_BYTES};
use crate::cell_error::cell_error;
use crate::csv_log::text_rows::{MARKS, rows};
use crate::recorded::CampaignError;

/// The cells of a frame in a row.
struct Frames {
    mark: u8,
    /// Byte offset below the header.
    begin: usize,
    time: usize,
    /// Size of the unit of time, s.
    unit_s: f64,
    id: usize,
    data: usize,
    /// Whether each byte has its own cell, from `data` on.
    is_split: bool,
    is_base64: bool,
    channel: Option<usize>,
    extended: Option<usize>,
    /// Cells that are true for a frame without data.
    others: Vec<usize>,
}

impl Frames {
    /// By the names of the first row; `None` for another table.
    fn of(text: &str) -> Option<Self> {
        MARKS.into_iter().find_map(|mark| {
            let mut all = rows(text, 0, mark);
            let names: Vec<String> = all.next()?.1.iter().map(str::to_lowercase).collect();
            let find = |known: &[&str]| names.iter().position(|name| known.contains(&&**name));
            let bytes = find(&["d1"]);
            let others = [find(&["remote"]), find(&["error"])];
            let time = find(&["timestampepoch", "timestamp", "time stamp"])?;
            Some(Self {
                mark,
                time,
                unit_s: if names[time].contains(' ') { 1e-6 } else { 1.0 },
                id: find(&["id", "arbitration_id"])?,
                data: find(&["databytes", "data"]).or(bytes)?,
                is_split: bytes.is_some(),
                is_base64: find(&["arbitration_id"]).is_some(),
                channel: find(&["buschannel", "bus"]),
                extended: find(&["ide", "extended"]),
                others: others.into_iter().flatten().collect(),
                begin: all.next().map_or(text.len(), |(byte, _)| byte),
            })
        })
    }

    fn id(&self, row: &StringRecord) -> Option<Id> {
        let text = row.get(self.id)?;
        let digits = text.trim_start_matches("0x");
        let is_extended = match self.extended.and_then(|cell| row.get(cell)) {
            Some(cell) => is_true(cell),
            None => digits.len() > 3,
        };
        Id::new(u32::from_str_radix(digits, 16).ok()?, is_extended)
    }

    fn data(&self, row: &StringRecord) -> Option<Vec<u8>> {
        let text: String = if self.is_split {
            row.iter().skip(self.data).collect()
        } else {
            row.get(self.data)?.to_owned()
        };
        let data = if self.is_base64 {
            of_base64(&text)?
        } else {
            of_hex(text.trim_start_matches("0x"))?
        };
        (data.len() <= MOST_BYTES).then_some(data)
    }
}

/// Whether a table is one of frames.
pub fn is_one(text: &str) -> bool {
    Frames::of(text).is_some()
}

/// Passes every data frame that `sink` wants to it.
///
/// # Errors
/// The first fault, with line and column.
pub fn read(source: &SourceFile, sink: &mut dyn FrameSink) -> Result<(), CampaignError> {
    let Some(frames) = Frames::of(&source.text) else {
        let hint = "export it as .asc or .blf with the logger's tool";
        return Err(source.error("is not a table of frames", hint));
    };
    for (byte, row) in rows(&source.text, frames.begin, frames.mark) {
        if row.iter().all(str::is_empty) {
            continue;
        }
        let fault = |index: usize, what: &str, hint: &str| {
            let what = format!("{} {what}", quote(row.get(index).unwrap_or_default()));
            cell_error(source, byte, (index, frames.mark.into()), what, hint)
        };
        let cell = |index: usize| row.get(index).unwrap_or_default();
        if frames.others.iter().any(|&index| is_true(cell(index))) {
            continue;
        }
        let id = frames.id(&row).ok_or_else(|| {
            let hint = "write it in hexadecimal digits, of at most 29 bits";
            fault(frames.id, "is not an identifier", hint)
        })?;
        let channel = frames.channel.map_or("1", cell);
        if !sink.wants(channel, id) {
            continue;
        }
        let time: Option<f64> = cell(frames.time).parse().ok();
        let time = time.filter(|time| time.is_finite()).ok_or_else(|| {
            let hint = "write it as a number of seconds";
            fault(frames.time, "is not a time", hint)
        })?;
        let data = frames.data(&row).ok_or_else(|| {
            let hint = "each byte has two hexadecimal digits; delete the row if it is truncated";
            fault(frames.data, "is not the data of a frame", hint)
        })?;
        sink.take(&Frame {
            time_s: time * frames.unit_s,
            channel,
            id,
            data: &data,
            byte,
        })?;
    }
    Ok(())
}

fn is_true(cell: &str) -> bool {
    cell == "1" || cell.eq_ignore_ascii_case("true")
}

fn of_hex(text: &str) -> Option<Vec<u8>> {
    let digit = |c: char| c.to_digit(16).map(|digit| digit as u8);
    let digits: Option<Vec<u8>> = text.chars().filter(|c| *c != ' ').map(digit).collect();
    let pairs = digits?;
    let is_whole = pairs.len().is_multiple_of(2);
    is_whole.then(|| pairs.chunks(2).map(|pair| pair[0] << 4 | pair[1]).collect())
}

/// RFC 4648, section 4.
fn of_base64(text: &str) -> Option<Vec<u8>> {
    const DIGITS: &[u8] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let (mut bits, mut count, mut bytes) = (0_u32, 0, Vec::new());
    for byte in text.trim_end_matches('=').bytes() {
        let digit = DIGITS.iter().position(|digit| *digit == byte)?;
        bits = bits << 6 | digit as u32;
        count += 6;
        if count >= 8 {
            count -= 8;
            bytes.push((bits >> count) as u8);
        }
    }
    Some(bytes)
}
