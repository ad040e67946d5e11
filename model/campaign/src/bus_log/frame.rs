//! A logged frame.

/// Data bytes of the longest frame, of CAN FD.
pub const MOST_BYTES: usize = 64;

/// Largest identifier with 11 bits.
const LARGEST_STANDARD: u32 = 0x7FF;
/// Largest identifier with 29 bits.
const LARGEST_EXTENDED: u32 = 0x1FFF_FFFF;

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
        match is_extended {
            true => (raw <= LARGEST_EXTENDED).then_some(Self::Extended(raw)),
            false => (raw <= LARGEST_STANDARD).then_some(Self::Standard(raw)),
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
