//! What tools name in the memory of a slave: pages, texts and ranges.

use super::event::Event;

/// Page of the calibration.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum Page {
    /// In RAM; can be written.
    #[default]
    Working = 0,
    /// As stored in flash; read-only.
    Reference = 1,
}

impl Page {
    /// The page with a number.
    #[must_use]
    pub const fn from_number(number: u8) -> Option<Self> {
        match number {
            0 => Some(Self::Working),
            1 => Some(Self::Reference),
            _ => None,
        }
    }
}

/// A text that tools request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Text {
    /// Identity that the description file has to match.
    Identity,
    /// Name of the description file, without extension.
    DescriptionFile,
    /// Name of an event.
    Event(Event),
}

/// A range of memory.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MemoryRange {
    /// First byte.
    pub address: u32,
    /// Number of bytes.
    pub length: u8,
}
