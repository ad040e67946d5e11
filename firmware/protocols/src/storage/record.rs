//! A block of a calibration as it is stored: the safety values, or all others.
//!
//! ```text
//! word 0      1         2                3        ...                          last
//! magic       sequence  words in record  version  entries                      CRC-32
//!                                                 key << 8 | count, values...  of all before
//! ```
//!
//! Words are little-endian. Keys are those of [`calibration_words`](hitch_quantities::calibration::calibration_words): they come from
//! names, units and scales, so an entry is found whatever else has been added, removed or moved since, in either block.

use hitch_quantities::calibration::calibration_words::{
    CALIBRATION_WORDS, ITEM_COUNT, Item, SAFETY_ITEM_COUNT, items, word_range,
};
use hitch_quantities::calibration::linkage::LINKAGE_POINTS;
use hitch_quantities::calibration::valve_table::VALVE_POINTS;
use hitch_quantities::{Calibration, ValidCalibration};

/// Most values of an entry: those of a valve, the number of its points and two for each.
const LARGEST_COUNT: usize = 1 + 2 * VALVE_POINTS;
const _: () = assert!(LARGEST_COUNT >= 2 + LINKAGE_POINTS, "the linkage has more");

/// Words before the entries.
pub const HEADER_WORDS: usize = 4;

/// A block of the store, with a record of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Block {
    /// The values of the safety class.
    Safety,
    /// All other values. Firmware before version 5 of the block kept the safety values here too.
    Machine,
}

impl Block {
    /// First word of its record: "HSAF" or "HCAL".
    #[must_use]
    pub const fn magic(self) -> u32 {
        match self {
            Self::Safety => u32::from_le_bytes(*b"HSAF"),
            Self::Machine => u32::from_le_bytes(*b"HCAL"),
        }
    }

    /// Number of words in its record by this firmware: header, a head for each entry, all values, and the checksum.
    /// Version and checksum of the calibration aren't among the values.
    #[must_use]
    pub const fn record_words(self) -> usize {
        let (items, values) = match self {
            Self::Safety => (SAFETY_ITEM_COUNT, SAFETY_ITEM_COUNT),
            Self::Machine => (
                ITEM_COUNT - SAFETY_ITEM_COUNT,
                CALIBRATION_WORDS - 2 - SAFETY_ITEM_COUNT,
            ),
        };
        HEADER_WORDS + items + values + 1
    }

    /// The words of its record, without the checksum.
    pub fn words(
        self,
        calibration: &[i32; CALIBRATION_WORDS],
        sequence: u32,
    ) -> impl Iterator<Item = u32> {
        let [version, ..] = *calibration;
        let length = self.record_words() as u32;
        let header = [self.magic(), sequence, length, version.cast_unsigned()];
        let entries = items()
            .filter(move |item| item.is_safety == (self == Self::Safety))
            .flat_map(move |item| {
                let head = (item.key << 8) | u32::from(item.count);
                let values = calibration
                    .get(item.first..)
                    .unwrap_or(&[])
                    .iter()
                    .take(usize::from(item.count));
                core::iter::once(head).chain(values.map(|value| value.cast_unsigned()))
            });
        header.into_iter().chain(entries)
    }
}

/// The beginning of a record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Header {
    /// Which block it is.
    pub block: Block,
    /// Rises by one with each record that is written; wraps.
    pub sequence: u32,
    /// All words, header and checksum included.
    pub words: u32,
    /// Version of the calibration that it was made from.
    pub version: u32,
}

impl Header {
    /// The header of four words, if it is one.
    #[must_use]
    pub fn from_words([magic, sequence, words, version]: [u32; HEADER_WORDS]) -> Option<Self> {
        let block = [Block::Safety, Block::Machine]
            .into_iter()
            .find(|block| block.magic() == magic)?;
        Some(Self {
            block,
            sequence,
            words,
            version,
        })
    }
}

/// What became of a record's entries.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Carried {
    /// Values that this firmware has and the record hadn't, or had out of range: they have their defaults.
    pub defaulted: u16,
    /// Entries of the record that this firmware doesn't know.
    pub unknown: u16,
}

/// A calibration that is made from the entries of its records, from whatever firmware.
#[derive(Debug)]
pub(super) struct Decoder {
    block: [i32; CALIBRATION_WORDS],
    found: u16,
    unknown: u16,
}

/// Begins with the factory's calibration.
pub(super) fn factory() -> Decoder {
    Decoder {
        block: Calibration::nominal().to_words(),
        found: 0,
        unknown: 0,
    }
}

impl Decoder {
    /// Takes the entries of a record.
    pub(super) fn take_entries(&mut self, mut entries: impl Iterator<Item = u32>) {
        while let Some(head) = entries.next() {
            let count = usize::try_from(head & 0xFF).unwrap_or(0);
            let known =
                items().find(|item| item.key == head >> 8 && usize::from(item.count) == count);
            let values = entries.by_ref().take(count);
            let Some(item) = known else {
                values.for_each(drop);
                self.unknown = self.unknown.saturating_add(1);
                continue;
            };
            if take_values(&mut self.block, item, values) {
                self.found = self.found.saturating_add(1);
            }
        }
    }

    /// The calibration. `None` if the entries make none, or if none of them was known: the defaults alone are no stored
    /// calibration.
    pub(super) fn finish(&self) -> Option<(ValidCalibration, Carried)> {
        if self.found == 0 {
            return None;
        }
        let all = u16::try_from(ITEM_COUNT).unwrap_or(u16::MAX);
        let carried = Carried {
            defaulted: all.saturating_sub(self.found),
            unknown: self.unknown,
        };
        let calibration = Calibration::from_words(&self.block).seal().ok()?;
        Some((calibration, carried))
    }
}

/// Puts the values of an entry into the block; false, and nothing changed, if one is missing or out of its range.
fn take_values(
    block: &mut [i32; CALIBRATION_WORDS],
    item: Item,
    values: impl Iterator<Item = u32>,
) -> bool {
    let mut taken = [0; LARGEST_COUNT];
    let count = usize::from(item.count);
    let mut rest = count;
    let mut good = true;
    let places = (item.first..CALIBRATION_WORDS).zip(&mut taken);
    for ((index, place), value) in places.zip(values) {
        *place = value.cast_signed();
        good &= word_range(index).is_some_and(|range| (range.min..=range.max).contains(place));
        rest = rest.saturating_sub(1);
    }
    let target = item.first..item.first.saturating_add(count);
    match (block.get_mut(target), taken.get(..count)) {
        (Some(target), Some(taken)) if good && rest == 0 => {
            target
                .iter_mut()
                .zip(taken)
                .for_each(|(place, value)| *place = *value);
            true
        }
        _ => false,
    }
}
