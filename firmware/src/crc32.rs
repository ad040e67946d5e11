//! The one CRC of this firmware; a table of it takes a kilobyte.

/// CRC-32 (ISO-HDLC), as in Ethernet and zip files.
pub static CRC_32: crc::Crc<u32> = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC);
