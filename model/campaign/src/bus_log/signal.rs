//! A signal in the data of a frame.

use std::ops::RangeInclusive;

/// Number format of a signal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Unsigned integer.
    Unsigned,
    /// Two's complement.
    Signed,
    /// IEEE 754, 32 bits.
    Float,
    /// IEEE 754, 64 bits.
    Double,
}

/// Position of a signal in the data.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Bits {
    /// Start bit as in a DBC: the lowest bit, or for big-endian signals the highest one.
    pub start: usize,
    /// Number of bits: 1 to 64.
    pub size: usize,
    /// Big-endian (Motorola).
    pub is_big_endian: bool,
}

impl Bits {
    /// The raw value; `None` if the data are too short.
    fn of(self, data: &[u8]) -> Option<u64> {
        let mut value = 0;
        let mut place = self.start;
        for index in 0..self.size {
            let bit = u64::from(*data.get(place / 8)? >> (place % 8) & 1);
            if self.is_big_endian {
                value = value << 1 | bit;
                // Bits of a byte are counted from its lowest: bit 0 is followed by bit 7 of the next byte.
                place = if place.is_multiple_of(8) {
                    place + 15
                } else {
                    place - 1
                };
            } else {
                value |= bit << index;
                place += 1;
            }
        }
        Some(value)
    }
}

/// A multiplexer, and its values that select a signal.
#[derive(Debug, Clone, PartialEq)]
pub struct Selector {
    /// Position of the multiplexer.
    pub bits: Bits,
    /// Ranges of the values.
    pub values: Vec<RangeInclusive<u64>>,
}

/// A signal.
#[derive(Debug, Clone, PartialEq)]
pub struct Signal {
    /// Display name: message and signal.
    pub name: String,
    /// Position.
    pub bits: Bits,
    /// Number format.
    pub kind: Kind,
    /// Factor, in the wanted unit per count.
    pub factor: f64,
    /// Offset, in the wanted unit.
    pub offset: f64,
    /// Values from `0xFB` in the highest byte on mean that no data are available (J1939-71).
    pub has_reserved_values: bool,
    /// Multiplexing: it is present only if each of these selects it.
    pub selected_by: Vec<Selector>,
}

/// The data are shorter than the signal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TooShort;

impl Signal {
    /// Its value in the data of a frame; `None` if it is not present, NaN if the sender has no valid value.
    pub fn value(&self, data: &[u8]) -> Result<Option<f64>, TooShort> {
        for selector in &self.selected_by {
            let value = selector.bits.of(data).ok_or(TooShort)?;
            if !selector.values.iter().any(|values| values.contains(&value)) {
                return Ok(None);
            }
        }
        let counts = self.bits.of(data).ok_or(TooShort)?;
        if self.has_reserved_values && self.is_reserved(counts) {
            return Ok(Some(f64::NAN));
        }
        let unused = 64 - self.bits.size;
        let counts = match self.kind {
            Kind::Unsigned => counts as f64,
            Kind::Signed => ((counts << unused).cast_signed() >> unused) as f64,
            // Their sizes were checked with the description.
            Kind::Float => f64::from(f32::from_bits(counts as u32)),
            Kind::Double => f64::from_bits(counts),
        };
        Ok(Some(counts * self.factor + self.offset))
    }

    fn is_reserved(&self, counts: u64) -> bool {
        const FIRST_RESERVED: u64 = 0xFB;
        let is_whole = self.bits.size.is_multiple_of(8) && self.kind == Kind::Unsigned;
        is_whole && counts >> (self.bits.size - 8) >= FIRST_RESERVED
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bits(start: usize, size: usize, is_big_endian: bool) -> Bits {
        Bits {
            start,
            size,
            is_big_endian,
        }
    }

    fn signal(bits: Bits, kind: Kind) -> Signal {
        Signal {
            name: "M.S".to_owned(),
            bits,
            kind,
            factor: 0.5,
            offset: -10.0,
            has_reserved_values: false,
            selected_by: Vec::new(),
        }
    }

    #[test]
    fn bits_are_found_in_either_order() {
        let data = [0x12, 0x34, 0x56];
        assert_eq!(bits(0, 16, false).of(&data), Some(0x3412));
        assert_eq!(bits(4, 12, false).of(&data), Some(0x341));
        assert_eq!(bits(7, 16, true).of(&data), Some(0x1234));
        assert_eq!(bits(3, 12, true).of(&data), Some(0x234));
        assert_eq!(bits(12, 16, false).of(&data), None);
    }

    #[test]
    fn numbers_have_sign_and_scale() {
        let negative = signal(bits(0, 12, false), Kind::Signed).value(&[0xFE, 0x0F]);
        assert_eq!(negative, Ok(Some(-11.0)));
        let float = signal(bits(0, 32, false), Kind::Float).value(&1.5_f32.to_le_bytes());
        assert_eq!(float, Ok(Some(-9.25)));
        let short = signal(bits(0, 16, false), Kind::Unsigned).value(&[1]);
        assert_eq!(short, Err(TooShort));
    }

    #[test]
    fn reserved_counts_are_no_data_and_a_selector_selects() {
        let mut of_j1939 = signal(bits(0, 16, false), Kind::Unsigned);
        of_j1939.has_reserved_values = true;
        assert_eq!(of_j1939.value(&[0xFF, 0xFA]), Ok(Some(32_117.5)));
        assert!(of_j1939.value(&[0, 0xFB]).unwrap().unwrap().is_nan());
        of_j1939.selected_by = vec![Selector {
            bits: bits(16, 2, false),
            values: vec![1..=1, 3..=3],
        }];
        assert_eq!(of_j1939.value(&[0, 0, 3]), Ok(Some(-10.0)));
        assert_eq!(of_j1939.value(&[0, 0, 2]), Ok(None));
        assert_eq!(of_j1939.value(&[0, 0, 1]), Ok(Some(-10.0)));
    }
}
