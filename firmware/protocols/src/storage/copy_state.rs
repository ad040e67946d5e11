//! What the blocks of a copy are worth.

use embedded_storage::nor_flash::NorFlash;
use hitch_quantities::crc32::Crc32;

use super::layout::{CHUNK, Copy, SAFETY_BYTES};
use super::reader::Reader;
use super::record::Block;

/// A block of a copy.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum BlockState {
    /// Its checksum is right.
    Good {
        /// Its number.
        sequence: u32,
    },
    /// Never written, or just erased.
    Blank,
    /// Neither.
    #[default]
    Damaged,
}

impl BlockState {
    pub(super) const fn sequence(self) -> Option<u32> {
        match self {
            Self::Good { sequence } => Some(sequence),
            Self::Blank | Self::Damaged => None,
        }
    }

    pub(super) const fn is_good(self) -> bool {
        matches!(self, Self::Good { .. })
    }
}

/// Both blocks of a copy.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct CopyState {
    pub(super) safety: BlockState,
    pub(super) machine: BlockState,
    /// Offset of the machine block in the copy. At 0 it is that of earlier firmware, with the safety values in it.
    machine_place: usize,
}

impl CopyState {
    /// Examines the blocks between two offsets of the flash.
    pub(super) fn examine<F: NorFlash>(
        flash: &mut F,
        start: usize,
        end: usize,
    ) -> Result<Self, F::Error> {
        let first = Found::at(flash, start, end)?;
        if first.block == Some(Block::Machine) {
            return Ok(Self {
                safety: first.state,
                machine: first.state,
                machine_place: 0,
            });
        }
        let machine_place = match (first.block, first.state) {
            (Some(_), BlockState::Good { .. }) => first.bytes.div_ceil(CHUNK).saturating_mul(CHUNK),
            _ => SAFETY_BYTES,
        };
        let second = Found::at(flash, start.saturating_add(machine_place), end)?;
        let machine = match (second.block, second.state) {
            (Some(Block::Safety), _) => BlockState::Damaged,
            (_, state) => state,
        };
        Ok(Self {
            safety: first.state,
            machine,
            machine_place,
        })
    }

    /// The same without the machine block.
    pub(super) const fn without_machine(self) -> Self {
        Self {
            machine: BlockState::Damaged,
            ..self
        }
    }

    pub(super) const fn copy(&self) -> Copy {
        match (self.safety, self.machine) {
            (BlockState::Good { .. }, BlockState::Good { sequence }) => Copy::Good { sequence },
            (BlockState::Blank, BlockState::Blank) => Copy::Blank,
            _ => Copy::Damaged,
        }
    }

    pub(super) fn is_blank(&self) -> bool {
        self.copy() == Copy::Blank
    }

    /// Offsets of the good blocks in the copy.
    pub(super) fn places(&self) -> [Option<usize>; 2] {
        let safety = self.safety.is_good() && self.machine_place > 0;
        [
            safety.then_some(0),
            self.machine.is_good().then_some(self.machine_place),
        ]
    }
}

/// A record, or what is in its place.
struct Found {
    block: Option<Block>,
    state: BlockState,
    /// Length, if the record is good.
    bytes: usize,
}

impl Found {
    fn at<F: NorFlash>(flash: &mut F, start: usize, end: usize) -> Result<Self, F::Error> {
        let mut reader = Reader::new(flash, start, end);
        let first = reader.header_words()?;
        let mut found = Self {
            block: None,
            state: BlockState::Damaged,
            bytes: 0,
        };
        let Some((header, rest)) = reader.record_after(first) else {
            if first.iter().all(|&word| word == u32::MAX) {
                found.state = BlockState::Blank;
            }
            return Ok(found);
        };
        found.block = Some(header.block);
        found.bytes = usize::try_from(header.words).unwrap_or(0).saturating_mul(4);
        let mut digest = Crc32::default();
        first
            .iter()
            .for_each(|word| digest.update(&word.to_le_bytes()));
        for _ in 0..rest {
            digest.update(&reader.word()?.to_le_bytes());
        }
        if reader.word()? == digest.value() {
            found.state = BlockState::Good {
                sequence: header.sequence,
            };
        }
        Ok(found)
    }
}
