//! A frame as a logger heard it.

/// Bytes of the longest frame, which CAN FD has.
pub const MOST_BYTES: usize = 64;

/// Largest identifier of 11 bits.
const LARGEST_STANDARD: u32 = 0x7FF;
/// Largest identifier of 29 bits.
const LARGEST_EXTENDED: u32 = 0x1FFF_FFFF;

/// An identifier.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Id {
    /// 11 bits.
    Standard(u32),
    /// 29 bits.
    Extended(u32),
}

impl Id {
    /// An identifier of the given kind, if it fits.
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
    /// When it was heard, s, since whatever the log counts from.
    pub time_s: f64,
    /// Which bus it was heard on, as the log names it.
    pub channel: &'a str,
    /// Its identifier.
    pub id: Id,
    /// Its data.
    pub data: &'a [u8],
    /// Where it stands in the log.
    pub byte: usize,
}
