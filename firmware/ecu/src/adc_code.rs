//! A code of an analog-to-digital converter.

/// A code of the converter: 0 to 4095.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct AdcCode(u16);

impl AdcCode {
    /// Full scale.
    pub const MAX: Self = Self(4095);

    /// The code of a converter's data register; the bits above the twelfth are dropped.
    #[must_use]
    pub const fn new(register: u16) -> Self {
        Self(register & Self::MAX.0)
    }

    /// The code as a number.
    #[must_use]
    pub const fn get(self) -> u16 {
        self.0
    }

    pub(crate) const fn wide(self) -> i32 {
        self.0 as i32
    }
}
