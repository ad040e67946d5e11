//! The one CRC of this firmware: CRC-32 of ISO-HDLC, as in Ethernet and zip files.

use crc::{CRC_32_ISO_HDLC, Crc, Digest, Table};

static ALGORITHM: Crc<u32, Table<1>> = Crc::<u32, Table<1>>::new(&CRC_32_ISO_HDLC);

/// A checksum under way.
#[derive(Clone)]
pub struct Crc32(Digest<'static, u32, Table<1>>);

impl core::fmt::Debug for Crc32 {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_tuple("Crc32").field(&self.value()).finish()
    }
}

impl Default for Crc32 {
    fn default() -> Self {
        Self(ALGORITHM.digest())
    }
}

impl Crc32 {
    /// The checksum of all of it.
    #[must_use]
    pub fn of(bytes: &[u8]) -> u32 {
        ALGORITHM.checksum(bytes)
    }

    /// Goes on with these.
    pub fn update(&mut self, bytes: &[u8]) {
        self.0.update(bytes);
    }

    /// The checksum of all bytes so far.
    #[must_use]
    pub fn value(&self) -> u32 {
        self.0.clone().finalize()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_has_the_check_value_of_the_catalogue_in_any_pieces() {
        assert_eq!(Crc32::of(b"123456789"), 0xCBF4_3926);
        let mut pieces = Crc32::default();
        pieces.update(b"1234");
        pieces.update(b"56789");
        assert_eq!(pieces.value(), 0xCBF4_3926);
    }
}
