//! The one CRC of this firmware; a table of it takes a kilobyte.

use core::fmt;

static CRC: crc::Crc<u32> = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC);

/// A CRC-32 (ISO-HDLC, as in Ethernet and zip files) under way.
#[derive(Clone)]
pub struct Crc32(crc::Digest<'static, u32>);

impl Default for Crc32 {
    fn default() -> Self {
        Self(CRC.digest())
    }
}

impl fmt::Debug for Crc32 {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Crc32")
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

    /// Goes on with these. Not inlined: unrolled wherever it is used, it took two kilobytes of the ECU's flash.
    #[inline(never)]
    pub fn update(&mut self, bytes: &[u8]) {
        self.0.update(bytes);
    }

    /// The checksum of what there was.
    #[must_use]
    pub fn value(&self) -> u32 {
        self.0.clone().finalize()
    }
}
