//! The key of the safety values: challenge and response by HMAC-SHA-256 (RFC 2104, FIPS 180-4) with a secret that is set
//! at the end of the line.
//!
//! The secret has flash of its own. The programmer writes it; nothing in the firmware does, and no address of XCP leads
//! to it.

use embedded_storage::nor_flash::ReadNorFlash;
use hitch_quantities::crc32::Crc32;
use hitch_quantities::image::Writer;
use hmac::{Hmac, KeyInit, Mac};
use sha2::Sha256;

/// Bytes of a secret.
pub const SECRET_BYTES: usize = 32;
/// Bytes of a challenge.
pub const SEED_BYTES: usize = 16;
/// Bytes of a response.
pub const RESPONSE_BYTES: usize = 32;
/// Bytes of the record in flash: "HKEY", the secret, and a CRC-32 of both in little-endian order.
pub const RECORD_BYTES: usize = 4 + SECRET_BYTES + 4;

const MAGIC: [u8; 4] = *b"HKEY";

/// A challenge.
pub type Seed = [u8; SEED_BYTES];

/// What makes a challenge new, besides the time in microseconds.
///
/// The number of the safety block rises with each storing; the noise of the converters differs from start to start.
/// Both together are no true random number: whoever can replay the converters' codes bit by bit, and asks in the
/// same microsecond after power-up without a storing in between, gets the same challenge.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Nonce {
    /// Serial number of the part.
    pub serial_number: u32,
    /// Number of the safety block in use.
    pub safety_sequence: u32,
    /// Hash of all converter codes since the start.
    pub noise: u32,
}

impl Nonce {
    /// Adds the converters' codes of a millisecond to the noise (FNV-1a by code).
    pub fn stir(&mut self, codes: impl IntoIterator<Item = u16>) {
        for code in codes {
            self.noise = (self.noise ^ u32::from(code)).wrapping_mul(0x0100_0193);
        }
    }

    /// The challenge at this time, us.
    #[must_use]
    pub fn seed(self, now_us: u32) -> Seed {
        let mut seed = Writer::default();
        for part in [self.serial_number, self.safety_sequence, now_us, self.noise] {
            seed.put(part.to_le_bytes());
        }
        seed.bytes()
    }
}

/// A secret. Its debug output does not show it.
#[derive(Clone, PartialEq, Eq)]
pub struct Secret([u8; SECRET_BYTES]);

impl core::fmt::Debug for Secret {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str("Secret")
    }
}

impl Secret {
    /// A secret. `None` for one whose bytes are all equal, as those of erased flash.
    #[must_use]
    pub fn new(bytes: [u8; SECRET_BYTES]) -> Option<Self> {
        let [first, rest @ ..] = bytes;
        let is_uniform = rest.iter().all(|&byte| byte == first);
        (!is_uniform).then_some(Self(bytes))
    }

    /// The secret at the start of `flash`, if one is set.
    pub fn load<F: ReadNorFlash>(flash: &mut F) -> Option<Self> {
        let mut record = [0; RECORD_BYTES];
        flash.read(0, &mut record).ok()?;
        Self::from_record(&record)
    }

    /// The secret of a record; `None` if it is none.
    #[must_use]
    pub fn from_record(record: &[u8; RECORD_BYTES]) -> Option<Self> {
        let (magic, rest) = record.split_first_chunk()?;
        let (secret, rest) = rest.split_first_chunk()?;
        let (stored, _) = rest.split_first_chunk()?;
        let is_whole = *magic == MAGIC && u32::from_le_bytes(*stored) == checksum(secret);
        Self::new(*secret).filter(|_| is_whole)
    }

    /// Its record.
    #[must_use]
    pub fn to_record(&self) -> [u8; RECORD_BYTES] {
        let mut record = Writer::default();
        record.put(MAGIC);
        record.put(self.0);
        record.put(checksum(&self.0).to_le_bytes());
        record.bytes()
    }

    /// The response to a challenge: its HMAC-SHA-256 under this secret.
    #[must_use]
    pub fn response(&self, seed: &Seed) -> [u8; RESPONSE_BYTES] {
        self.mac(seed).finalize().into_bytes().into()
    }

    /// Whether `response` answers the challenge; compared in constant time.
    #[must_use]
    pub fn accepts(&self, seed: &Seed, response: &[u8; RESPONSE_BYTES]) -> bool {
        self.mac(seed).verify(response.into()).is_ok()
    }

    fn mac(&self, seed: &Seed) -> Hmac<Sha256> {
        let mut key = hmac::digest::Key::<Hmac<Sha256>>::default();
        key.iter_mut()
            .zip(&self.0)
            .for_each(|(target, byte)| *target = *byte);
        // A key of a whole block of 64 bytes: a shorter one is filled up with zeros, by the definition of HMAC.
        let mut mac = Hmac::new(&key);
        mac.update(seed);
        mac
    }
}

fn checksum(secret: &[u8; SECRET_BYTES]) -> u32 {
    let mut digest = Crc32::default();
    digest.update(&MAGIC);
    digest.update(secret);
    digest.value()
}
