//! The checksum of a stretch of memory, a piece at a time: all of the calibration at once would take too long for one
//! step.

use hitch_quantities::crc32::Crc32;

use super::command::identifier;
use super::error::Refusal;
use super::memory::Memory;
use super::packet::{Packet, packet};

/// Bytes that are read at a time.
const PIECE: usize = 64;
/// Longest stretch: more than there is at one place.
pub(super) const LONGEST: u32 = 0x4000;
/// XCP's number of the method, CRC-32.
const METHOD: u8 = 0x09;

/// A checksum under way.
#[derive(Clone, Debug)]
pub(super) struct Checksum {
    address: u32,
    left: u32,
    sum: Crc32,
}

impl Checksum {
    /// A checksum of `length` bytes from `address` on.
    pub fn new(address: u32, length: u32) -> Self {
        Self {
            address,
            left: length,
            sum: Crc32::default(),
        }
    }

    /// Reads the next piece; the answer after the last one.
    pub fn advance(&mut self, memory: &impl Memory) -> Option<Packet> {
        let mut bytes = [0; PIECE];
        let wanted = usize::try_from(self.left).unwrap_or(PIECE).min(PIECE);
        let piece = bytes.get_mut(..wanted).unwrap_or(&mut []);
        if let Err(refusal) = memory.read(self.address, piece) {
            return Some(packet(identifier::ERROR, &[refusal as u8]));
        }
        self.sum.update(piece);
        let read = u32::try_from(piece.len()).unwrap_or(0);
        self.address = self.address.wrapping_add(read);
        self.left = self.left.saturating_sub(read);
        if self.left > 0 {
            return None;
        }
        let [a, b, c, d] = self.sum.value().to_le_bytes();
        Some(packet(identifier::RESPONSE, &[METHOD, 0, 0, a, b, c, d]))
    }
}

/// The refusal of a stretch that is too long: with how long it may be.
pub(super) fn too_long() -> Packet {
    let [a, b, c, d] = LONGEST.to_le_bytes();
    packet(
        identifier::ERROR,
        &[Refusal::OutOfRange as u8, 0, 0, a, b, c, d],
    )
}
