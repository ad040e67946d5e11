//! The one CRC of this firmware, half a byte at a time: a table of sixteen entries instead of 256, which took a
//! kilobyte of the ECU's flash. Twice the look-ups are a few thousand instructions for a whole calibration.

/// The polynomial of ISO-HDLC, lowest power first.
const POLYNOMIAL: u32 = 0xEDB8_8320;
const NIBBLES: usize = 16;

static TABLE: [u32; NIBBLES] = table();

const fn table() -> [u32; NIBBLES] {
    let mut table = [0; NIBBLES];
    let mut nibble = 0;
    while nibble < NIBBLES {
        let mut rest = nibble as u32;
        let mut bit = 0;
        while bit < 4 {
            rest = (rest >> 1) ^ if rest & 1 == 1 { POLYNOMIAL } else { 0 };
            bit += 1;
        }
        table[nibble] = rest;
        nibble += 1;
    }
    table
}

/// A CRC-32 (ISO-HDLC, as in Ethernet and zip files) under way.
#[derive(Clone, Debug)]
pub struct Crc32(u32);

impl Default for Crc32 {
    fn default() -> Self {
        Self(u32::MAX)
    }
}

impl Crc32 {
    /// The checksum of all of it.
    #[must_use]
    pub fn of(bytes: &[u8]) -> u32 {
        let mut checksum = Self::default();
        checksum.update(bytes);
        checksum.value()
    }

    /// Goes on with these.
    #[inline(never)]
    pub fn update(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.nibble(*byte);
            self.nibble(*byte >> 4);
        }
    }

    /// Goes on with the lower four bits.
    fn nibble(&mut self, bits: u8) {
        let index = (self.0 ^ u32::from(bits)) & 0xF;
        let entry = TABLE.get(index as usize).copied().unwrap_or(0);
        self.0 = (self.0 >> 4) ^ entry;
    }

    /// The checksum of what there was.
    #[must_use]
    pub fn value(&self) -> u32 {
        !self.0
    }
}

#[cfg(test)]
mod tests {
    use super::Crc32;

    #[test]
    fn is_the_one_that_everybody_has() {
        let other = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC);
        assert_eq!(Crc32::of(b"123456789"), 0xCBF4_3926);
        let bytes: [u8; 256] = core::array::from_fn(|index| index as u8);
        for length in 0..bytes.len() {
            let piece = &bytes[..length];
            assert_eq!(Crc32::of(piece), other.checksum(piece), "{length} bytes");
        }
    }
}
