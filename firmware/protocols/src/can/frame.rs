//! One frame of classic CAN.

use embedded_can::{ExtendedId, Id, StandardId};

/// A data or remote frame with an identifier of 11 or 29 bits and up to 8 bytes.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Frame {
    id: Id,
    remote: bool,
    length: u8,
    /// Bytes beyond the length are zero, so that equal frames are equal.
    bytes: [u8; Self::MOST_BYTES],
}

impl Frame {
    /// Maximum number of data bytes.
    pub const MOST_BYTES: usize = 8;

    /// A data frame, if `data` fits into one.
    #[must_use]
    pub fn data_frame(id: Id, data: &[u8]) -> Option<Self> {
        let mut bytes = [0; Self::MOST_BYTES];
        bytes.get_mut(..data.len())?.copy_from_slice(data);
        Some(Self {
            id,
            remote: false,
            length: u8::try_from(data.len()).ok()?,
            bytes,
        })
    }

    /// A data frame of eight bytes, as most of J1939 and XCP have.
    #[must_use]
    pub const fn of_eight(id: ExtendedId, bytes: [u8; Self::MOST_BYTES]) -> Self {
        Self {
            id: Id::Extended(id),
            remote: false,
            length: 8,
            bytes,
        }
    }

    /// A remote frame that requests `length` bytes, if a frame can have so many.
    #[must_use]
    pub fn remote_frame(id: Id, length: usize) -> Option<Self> {
        Some(Self {
            id,
            remote: true,
            length: u8::try_from(length).ok().filter(|&length| length <= 8)?,
            bytes: [0; Self::MOST_BYTES],
        })
    }

    /// The frame of a controller's registers, if `length` is at most eight; bytes beyond it don't count.
    #[must_use]
    pub fn from_padded(
        id: Id,
        is_remote: bool,
        length: u8,
        bytes: [u8; Self::MOST_BYTES],
    ) -> Option<Self> {
        if is_remote {
            Self::remote_frame(id, length.into())
        } else {
            Self::data_frame(id, bytes.get(..length.into())?)
        }
    }

    /// Its bytes as a controller's registers have them, filled up with zeros.
    #[must_use]
    pub const fn padded(&self) -> [u8; Self::MOST_BYTES] {
        self.bytes
    }

    /// Identifier.
    #[must_use]
    pub const fn id(&self) -> Id {
        self.id
    }

    /// The identifier, if it is a data frame with 29 bits: J1939 uses no others.
    #[must_use]
    pub const fn extended_data_id(&self) -> Option<ExtendedId> {
        match self.id {
            Id::Extended(id) if !self.remote => Some(id),
            _ => None,
        }
    }

    /// True for a remote frame.
    #[must_use]
    pub const fn is_remote(&self) -> bool {
        self.remote
    }

    /// The length code: bytes of a data frame, requested bytes of a remote frame.
    #[must_use]
    pub const fn length(&self) -> u8 {
        self.length
    }

    /// The bytes; a remote frame has none.
    #[must_use]
    pub fn data(&self) -> &[u8] {
        let length = if self.remote { 0 } else { self.length };
        self.bytes.get(..usize::from(length)).unwrap_or(&[])
    }

    /// All eight bytes, if there are eight.
    #[must_use]
    pub fn eight(&self) -> Option<&[u8; Self::MOST_BYTES]> {
        self.data().try_into().ok()
    }
}

impl core::fmt::Debug for Frame {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self.id {
            Id::Standard(id) => write!(f, "{:03X}", id.as_raw())?,
            Id::Extended(id) => write!(f, "{:08X}", id.as_raw())?,
        }
        if self.remote {
            return write!(f, " remote {}", self.length);
        }
        self.data()
            .iter()
            .try_for_each(|byte| write!(f, " {byte:02X}"))
    }
}

impl embedded_can::Frame for Frame {
    fn new(id: impl Into<Id>, data: &[u8]) -> Option<Self> {
        Self::data_frame(id.into(), data)
    }

    fn new_remote(id: impl Into<Id>, dlc: usize) -> Option<Self> {
        Self::remote_frame(id.into(), dlc)
    }

    fn is_extended(&self) -> bool {
        matches!(self.id, Id::Extended(_))
    }

    fn is_remote_frame(&self) -> bool {
        self.remote
    }

    fn id(&self) -> Id {
        self.id
    }

    fn dlc(&self) -> usize {
        usize::from(self.length)
    }

    fn data(&self) -> &[u8] {
        Self::data(self)
    }
}

/// The identifier of 11 bits with these bits; those above are dropped.
pub(super) fn standard_id(bits: u32) -> StandardId {
    let bits = u16::try_from(bits & 0x7FF).unwrap_or(0);
    StandardId::new(bits).unwrap_or(StandardId::ZERO)
}

/// The identifier of 29 bits with these bits; those above are dropped.
pub(crate) fn extended_id(bits: u32) -> ExtendedId {
    ExtendedId::new(bits & 0x1FFF_FFFF).unwrap_or(ExtendedId::ZERO)
}
