//! A logged frame, and its receiver.

use crate::recorded::CampaignError;

/// Data bytes of the longest frame, of CAN FD.
pub const MOST_BYTES: usize = 64;

/// Largest identifier with 11 bits.
const LARGEST_STANDARD: u32 = 0x7FF;
/// Largest identifier with 29 bits.
const LARGEST_EXTENDED: u32 = 0x1FFF_FFFF;

/// The parameter group number of a J1939 identifier: without the destination address, which groups in the lower half
/// have.
pub fn group(id: u32) -> u32 {
    const FIRST_BROADCAST: u32 = 240;
    let group = id >> 8 & 0x3_FFFF;
    match group >> 8 & 0xFF {
        format if format < FIRST_BROADCAST => group & 0x3_FF00,
        _ => group,
    }
}

/// A frame identifier.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Id {
    /// 11 bits.
    Standard(u32),
    /// 29 bits.
    Extended(u32),
}

impl Id {
    /// An identifier of the given kind, if it is in range.
    pub fn new(raw: u32, is_extended: bool) -> Option<Self> {
        if is_extended {
            (raw <= LARGEST_EXTENDED).then_some(Self::Extended(raw))
        } else {
            (raw <= LARGEST_STANDARD).then_some(Self::Standard(raw))
        }
    }

    /// Its parameter group, if it has 29 bits.
    pub fn group(self) -> Option<u32> {
        match self {
            Self::Extended(raw) => Some(group(raw)),
            Self::Standard(_) => None,
        }
    }
}

/// A frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame<'a> {
    /// Time stamp, s, from the log's origin.
    pub time_s: f64,
    /// The bus, as named in the log.
    pub channel: &'a str,
    /// Its identifier.
    pub id: Id,
    /// Its data.
    pub data: &'a [u8],
    /// Its position in the log.
    pub byte: usize,
}

/// A receiver of frames.
pub trait FrameSink {
    /// Whether data frames with this identifier on this channel are wanted; others are not parsed.
    fn wants(&mut self, channel: &str, id: Id) -> bool;

    /// Receives a wanted frame.
    ///
    /// # Errors
    /// The frame is not valid.
    fn take(&mut self, frame: &Frame<'_>) -> Result<(), CampaignError>;
}
