//! How a copy of the calibration lies in flash.

use embedded_storage::nor_flash::NorFlash;

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

/// Half of a flash, in whole pieces that are erased together.
pub(super) fn half_bytes<F: NorFlash>(flash: &F) -> usize {
    let half = flash.capacity() / 2;
    half.saturating_sub(half % F::ERASE_SIZE)
}

/// Those of two places that have a sequence, the newer one first.
pub(super) fn newest_first(sequences: [Option<u32>; 2]) -> impl Iterator<Item = usize> {
    let order = match sequences {
        [Some(first), Some(second)] => {
            // Sequences wrap; of two that were stored one after the other, the later one is one further on.
            if first.wrapping_sub(second).cast_signed() >= 0 {
                [Some(0), Some(1)]
            } else {
                [Some(1), Some(0)]
            }
        }
        [Some(_), None] => [Some(0), None],
        [None, Some(_)] => [Some(1), None],
        [None, None] => [None, None],
    };
    order.into_iter().flatten()
}

/// Flash is addressed with 32 bits.
pub(super) fn address(offset: usize) -> u32 {
    u32::try_from(offset).unwrap_or(u32::MAX)
}
