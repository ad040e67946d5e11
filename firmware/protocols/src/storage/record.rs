//! A calibration as it is stored.
//!
//! ```text
//! word 0      1         2                3        ...                          last
//! magic       sequence  words in record  version  entries                      CRC-32
//!                                                 key << 8 | count, values...  of all before
//! ```
//!
//! Words are little-endian. Keys are those of [`calibration_words`](hitch_quantities::calibration::calibration_words): they come from
//! names, units and scales, so an entry is found whatever else has been added, removed or moved since.

use hitch_quantities::calibration::calibration_words::{
    CALIBRATION_WORDS, ITEM_COUNT, Item, items, word_range,
};
use hitch_quantities::{Calibration, ValidCalibration};

/// "HCAL".
pub const MAGIC: u32 = u32::from_le_bytes(*b"HCAL");
/// Words before the entries.
pub const HEADER_WORDS: usize = 4;

/// The beginning of a record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Header {
    /// Rises by one with each record that is written; wraps.
    pub sequence: u32,
    /// All words, header and checksum included.
    pub words: u32,
    /// Version of the block that it was made from.
    pub version: u32,
}

impl Header {
    /// The header of four words, if it is one.
    #[must_use]
    pub const fn from_words(
        [magic, sequence, words, version]: [u32; HEADER_WORDS],
    ) -> Option<Self> {
        if magic != MAGIC {
            return None;
        }
        Some(Self {
            sequence,
            words,
            version,
        })
    }
}

/// Number of words in a record of this firmware: header, a head for each entry, all values, and the checksum. Version
/// and checksum of the block aren't among the values.
pub const RECORD_WORDS: usize = HEADER_WORDS + ITEM_COUNT + (CALIBRATION_WORDS - 2) + 1;

/// The words of a record, without its checksum.
pub fn words(calibration: &[i32; CALIBRATION_WORDS], sequence: u32) -> impl Iterator<Item = u32> {
    let [version, ..] = *calibration;
    let length = RECORD_WORDS as u32;
    let header = [MAGIC, sequence, length, version.cast_unsigned()];
    let entries = items().flat_map(move |item| {
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

/// What became of a record's entries.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Carried {
    /// Values that this firmware has and the record hadn't, or had out of range: they have their defaults.
    pub defaulted: u16,
    /// Entries of the record that this firmware doesn't know.
    pub unknown: u16,
}

/// Reads the entries of a record, from whatever firmware. `None` if what they make is no calibration, or if none of them
/// is known: the defaults alone are no stored calibration.
pub fn decode(mut entries: impl Iterator<Item = u32>) -> Option<(ValidCalibration, Carried)> {
    let mut block = Calibration::nominal().to_words();
    let mut found = 0_u16;
    let mut unknown = 0_u16;
    while let Some(head) = entries.next() {
        let count = usize::try_from(head & 0xFF).unwrap_or(0);
        let known = items().find(|item| item.key == head >> 8 && usize::from(item.count) == count);
        let values = entries.by_ref().take(count);
        let Some(item) = known else {
            values.for_each(drop);
            unknown = unknown.saturating_add(1);
            continue;
        };
        if take_values(&mut block, item, values) {
            found = found.saturating_add(1);
        }
    }
    if found == 0 {
        return None;
    }
    let all = u16::try_from(ITEM_COUNT).unwrap_or(u16::MAX);
    let carried = Carried {
        defaulted: all.saturating_sub(found),
        unknown,
    };
    let calibration = Calibration::from_words(&block).seal().ok()?;
    Some((calibration, carried))
}

/// Puts the values of an entry into the block; false, and nothing changed, if one is missing or out of its range.
fn take_values(
    block: &mut [i32; CALIBRATION_WORDS],
    item: Item,
    values: impl Iterator<Item = u32>,
) -> bool {
    let before = *block;
    let mut taken = 0_u8;
    let mut good = true;
    for (index, value) in (item.first..CALIBRATION_WORDS).zip(values) {
        let value = value.cast_signed();
        good &= word_range(index).is_some_and(|range| (range.min..=range.max).contains(&value));
        if let Some(word) = block.get_mut(index) {
            *word = value;
        }
        taken = taken.saturating_add(1);
    }
    good &= taken == item.count;
    if !good {
        *block = before;
    }
    good
}
