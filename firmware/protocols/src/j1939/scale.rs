//! Quantities of two bytes in messages (SAE J1939-71, ISO 11783-7).

/// Largest raw value that is data; reserved values, errors (FExx) and "not available" (FFxx) are above.
pub(super) const LARGEST: u16 = 0xFAFF;
/// Raw value: the signal is bad.
pub(super) const ERROR: u16 = 0xFE00;
/// Raw value: not available.
pub(super) const NOT_AVAILABLE: u16 = 0xFFFF;

/// Smallest value and resolution of a quantity, in counts of the controller.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Scale {
    pub(super) offset: i32,
    pub(super) per_bit: i32,
}

impl Scale {
    /// The raw value of `counts`, rounded to nearest; what is beyond the ends is at the end.
    pub(super) fn raw(self, counts: i32) -> u16 {
        let above = counts.saturating_sub(self.offset).max(0);
        let rounded = above.saturating_add(self.per_bit / 2) / self.per_bit.max(1);
        u16::try_from(rounded).unwrap_or(LARGEST).min(LARGEST)
    }
}

/// The raw value of two bytes, if it is data.
pub(super) fn data(bytes: [u8; 2]) -> Option<u16> {
    Some(u16::from_le_bytes(bytes)).filter(|&raw| raw <= LARGEST)
}
