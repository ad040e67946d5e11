//! CAN as ASCII lines (Lawicel's protocol, "slcan"), for a serial line or a socket.
//!
//! ```text
//! tIIILDD..\r   data frame, 11 bits     TIIIIIIIILDD..\r   data frame, 29 bits
//! rIIIL\r       remote frame            RIIIIIIIIL\r       remote frame
//! O\r L\r C\r   open, listen, close     S5\r               bit rate (of a bus that isn't there: ignored)
//! V\r N\r F\r   version, serial, flags  \r alone           nothing, to flush the line
//! ```
//!
//! A command is answered with `\r` (after its result, if any) or, if it fails, with a bell. Hosts start with an empty
//! or partial line; both are harmless.

use heapless::Vec;

use super::Frame;
use super::frame::{extended_id, standard_id};
use embedded_can::Id;

/// Longest line: `T`, 8 digits of identifier, 1 of length, 16 of data and `\r`.
pub const LONGEST_LINE: usize = 27;

/// Answer to a command that failed.
const BELL: &[u8] = b"\x07";

/// A line of text.
pub type Line = Vec<u8, LONGEST_LINE>;

/// Result of a completed line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Completed {
    /// A frame for the bus.
    pub frame: Option<Frame>,
    /// Answer to the host.
    pub reply: &'static [u8],
}

/// Device side of the line.
#[derive(Clone, Debug, Default)]
pub struct Adapter {
    line: Line,
    /// The current line is longer than any command.
    overlong: bool,
    open: Channel,
}

/// State of the channel, as set by the host.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Channel {
    #[default]
    Closed,
    Open,
    /// Frames go to the host only.
    Listening,
}

impl Adapter {
    /// Whether the host has opened the channel: only then are frames sent to it.
    #[must_use]
    pub fn is_open(&self) -> bool {
        self.open != Channel::Closed
    }

    /// Processes a byte from the host; `Some` at the end of a line.
    pub fn receive(&mut self, byte: u8) -> Option<Completed> {
        if byte == b'\n' {
            return None;
        }
        if byte != b'\r' {
            self.overlong |= self.line.push(byte).is_err();
            return None;
        }
        let completed = if self.overlong { None } else { self.dispatch() };
        self.line.clear();
        self.overlong = false;
        Some(completed.unwrap_or(Completed {
            frame: None,
            reply: BELL,
        }))
    }

    /// Executes a line; `None` if it is invalid.
    fn dispatch(&mut self) -> Option<Completed> {
        let Some((command, rest)) = self.line.split_first() else {
            return Some(done(b"\r"));
        };
        match command {
            b'O' => self.open = Channel::Open,
            b'L' => self.open = Channel::Listening,
            b'C' => self.open = Channel::Closed,
            // Bit rate, time stamps, filters: accepted without effect, as a socket has none of them.
            b'S' | b's' | b'Z' | b'M' | b'm' => {}
            b'V' => return Some(done(b"V1013\r")),
            b'N' => return Some(done(b"NH1TC\r")),
            b'F' => return Some(done(b"F00\r")),
            b't' | b'T' | b'r' | b'R' => {
                let frame = decode_frame(*command, rest)?;
                let may_send = self.open == Channel::Open;
                return may_send.then_some(Completed {
                    frame: Some(frame),
                    reply: if command.is_ascii_uppercase() {
                        b"Z\r"
                    } else {
                        b"z\r"
                    },
                });
            }
            _ => return None,
        }
        Some(done(b"\r"))
    }
}

const fn done(reply: &'static [u8]) -> Completed {
    Completed { frame: None, reply }
}

/// The frame of a line without its `\r`, if it is valid.
#[must_use]
pub fn decode(line: &[u8]) -> Option<Frame> {
    let (command, rest) = line.split_first()?;
    decode_frame(*command, rest)
}

fn decode_frame(command: u8, rest: &[u8]) -> Option<Frame> {
    let extended = command.is_ascii_uppercase();
    let (id, rest) = rest.split_at_checked(if extended { 8 } else { 3 })?;
    let id = hexadecimal(id)?;
    let id = match extended {
        true if id <= 0x1FFF_FFFF => Id::Extended(extended_id(id)),
        false if id <= 0x7FF => Id::Standard(standard_id(id)),
        _ => return None,
    };
    let (length, rest) = rest.split_first()?;
    let length = usize::try_from(digit(*length)?).ok()?;
    match command {
        b'r' | b'R' if rest.is_empty() => Frame::remote_frame(id, length),
        b't' | b'T' => {
            let mut data: Vec<u8, { Frame::MOST_BYTES }> = Vec::new();
            for pair in rest.chunks(2) {
                let byte = hexadecimal(pair).filter(|_| pair.len() == 2)?;
                data.push(u8::try_from(byte).ok()?).ok()?;
            }
            Frame::data_frame(id, &data).filter(|_| data.len() == length)
        }
        _ => None,
    }
}

/// The line of a frame, with its `\r`.
#[must_use]
pub fn encode(frame: &Frame) -> Line {
    let mut line = Line::new();
    // The pushed text is at most as long as the longest line.
    let mut put = |byte: u8| {
        let _ = line.push(byte);
    };
    let (command, id, digits) = match (frame.id(), frame.is_remote()) {
        (Id::Standard(id), false) => (b't', u32::from(id.as_raw()), 3),
        (Id::Standard(id), true) => (b'r', u32::from(id.as_raw()), 3),
        (Id::Extended(id), false) => (b'T', id.as_raw(), 8),
        (Id::Extended(id), true) => (b'R', id.as_raw(), 8),
    };
    put(command);
    (0..digits)
        .rev()
        .for_each(|place| put(figure(id >> (4 * place))));
    put(figure(u32::from(frame.length())));
    for &byte in frame.data() {
        put(figure(u32::from(byte >> 4)));
        put(figure(u32::from(byte)));
    }
    put(b'\r');
    line
}

/// The hexadecimal digit of the lowest four bits.
fn figure(bits: u32) -> u8 {
    b"0123456789ABCDEF"
        .get(usize::try_from(bits & 0xF).unwrap_or(0))
        .copied()
        .unwrap_or(b'0')
}

fn digit(figure: u8) -> Option<u32> {
    char::from(figure).to_digit(16)
}

fn hexadecimal(figures: &[u8]) -> Option<u32> {
    figures
        .iter()
        .try_fold(0, |value: u32, &figure| Some((value << 4) | digit(figure)?))
}
