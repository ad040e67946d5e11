//! Registers as written.

use std::collections::HashMap;

/// Words by address; those that were never written have their reset value.
#[derive(Clone, Debug, Default)]
pub struct Registers(HashMap<u32, u32>);

impl Registers {
    /// A register's word.
    #[must_use]
    pub fn get(&self, address: u32) -> u32 {
        self.0.get(&address).copied().unwrap_or(0)
    }

    /// Writes a word.
    pub fn set(&mut self, address: u32, value: u32) {
        self.0.insert(address, value);
    }

    /// Sets and clears bits.
    pub fn modify(&mut self, address: u32, clear: u32, set: u32) {
        self.set(address, self.get(address) & !clear | set);
    }

    /// A field of `width` bits from bit `shift` on.
    #[must_use]
    pub fn field(&self, address: u32, shift: u32, width: u32) -> u32 {
        self.get(address) >> shift & ((1 << width) - 1)
    }

    /// A bit.
    #[must_use]
    pub fn bit(&self, address: u32, bit: u32) -> bool {
        self.field(address, bit, 1) == 1
    }
}
