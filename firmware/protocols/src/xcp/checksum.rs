//! Checksum of a memory range, computed in pieces, because the whole calibration would take too long for one step.

use hitch_quantities::crc32::Crc32;

use super::command::identifier;
use super::error::Refusal;
use super::map::EcuMemory;
use super::packet::{Packet, packet};

/// Bytes of a piece.
const PIECE: usize = 64;
/// Longest range; larger than any memory region.
pub(super) const LONGEST: u32 = 0x4000;
/// XCP's code of the method, CRC-32.
const METHOD: u8 = 0x09;

/// A checksum in progress.
#[derive(Clone, Debug)]
pub(super) struct Checksum {
    address: u32,
    left: u32,
    sum: Crc32,
}

impl Checksum {
    /// A checksum of `length` bytes from `address`.
    pub fn new(address: u32, length: u32) -> Self {
        Self {
            address,
            left: length,
            sum: Crc32::default(),
        }
    }

    /// Processes the next piece; returns the answer after the last one.
    pub fn advance(&mut self, memory: &EcuMemory<'_>) -> Option<Packet> {
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

/// The refusal of a range that is too long, with the maximum length.
pub(super) fn too_long() -> Packet {
    let [a, b, c, d] = LONGEST.to_le_bytes();
    packet(
        identifier::ERROR,
        &[Refusal::OutOfRange as u8, 0, 0, a, b, c, d],
    )
}
