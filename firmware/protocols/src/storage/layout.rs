//! How a copy of the calibration lies in flash.

use super::record::Block;

/// Bytes that are read or programmed at a time: a multiple of what any flash takes at once.
pub(super) const CHUNK: usize = 32;
pub(super) const CHUNK_WORDS: usize = CHUNK / 4;
/// Bytes that the safety block of this firmware takes, the last chunk filled up. It is first in a copy.
pub(super) const SAFETY_BYTES: usize = (4 * Block::Safety.record_words()).next_multiple_of(CHUNK);
pub(super) const SAFETY_CHUNKS: usize = SAFETY_BYTES / CHUNK;
/// Bytes that both blocks take.
pub const COPY_BYTES: usize =
    SAFETY_BYTES + (4 * Block::Machine.record_words()).next_multiple_of(CHUNK);

/// One of the two copies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Copy {
    /// Complete: both blocks.
    Good {
        /// The higher one counts.
        sequence: u32,
    },
    /// Never written, or just erased.
    Blank,
    /// Neither: a power cut while it was written, worn-out flash, or contents that make no calibration.
    Damaged,
}

impl Copy {
    pub(super) const fn sequence(&self) -> Option<u32> {
        match *self {
            Self::Good { sequence } => Some(sequence),
            Self::Blank | Self::Damaged => None,
        }
    }
}

/// Flash is addressed with 32 bits.
pub(super) fn address(offset: usize) -> u32 {
    u32::try_from(offset).unwrap_or(u32::MAX)
}
