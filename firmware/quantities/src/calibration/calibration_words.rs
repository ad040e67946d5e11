//! The calibration block as a list of words, with what each may hold: the view that tools and storage have of it.

pub use super::block::GROUPS;
use super::block::{CALIBRATION_BYTES, CURRENT_LIMIT, Calibration, FLOW_LIMIT};
use super::class::{Class, Tightening};
use super::linkage::LINKAGE_POINTS;
pub use super::parameter::Group;
use super::parameter::{OutOfRange, ParameterInfo};
use super::valve_table::{VALVE_POINTS, ValveTable};
use crate::fnv;

/// Words in a block.
pub const CALIBRATION_WORDS: usize = CALIBRATION_BYTES / 4;

/// The word that holds the checksum.
const CHECKSUM_WORD: usize = CALIBRATION_WORDS - 1;

/// Words of a valve table: the number of points, then flow and current of each.
pub const VALVE_WORDS: usize = 1 + 2 * VALVE_POINTS;
/// Words of the linkage table: first angle, step, then the travel at each point.
pub const LINKAGE_WORDS: usize = 2 + LINKAGE_POINTS;
/// Word of the lift valve's table at which it begins.
pub const LIFT_WORD: usize = 1;
/// The same for the lowering valve.
pub const LOWER_WORD: usize = LIFT_WORD + VALVE_WORDS;
/// The same for the linkage.
pub const LINKAGE_WORD: usize = LOWER_WORD + VALVE_WORDS;
/// The first word of the scalars.
pub const SCALARS_WORD: usize = LINKAGE_WORD + LINKAGE_WORDS;

/// A hash of the name of a scalar with that of its group.
const fn full_name(group: &str, name: &str) -> u32 {
    fnv::text(fnv::text(fnv::START, group), name)
}

/// What a word may hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WordRange {
    /// Smallest.
    pub min: i32,
    /// Largest.
    pub max: i32,
    /// Who may change it, and when.
    pub class: Class,
}

/// What word `index` may hold; `None` for version and checksum, which belong to the block, and beyond its end.
#[must_use]
pub fn word_range(index: usize) -> Option<WordRange> {
    let (min, max) = match index {
        0 => return None,
        LIFT_WORD..LOWER_WORD => valve_range(index.wrapping_sub(LIFT_WORD)),
        LOWER_WORD..LINKAGE_WORD => valve_range(index.wrapping_sub(LOWER_WORD)),
        LINKAGE_WORD..SCALARS_WORD => linkage_range(index.wrapping_sub(LINKAGE_WORD)),
        _ => return scalar_range(index.wrapping_sub(SCALARS_WORD)),
    };
    Some(WordRange {
        min,
        max,
        class: Class::Machine,
    })
}

/// Largest number of points in a valve table.
const MOST_POINTS: i32 = VALVE_POINTS as i32;
/// A whole turn, in millidegrees.
const FULL_TURN: i32 = 360_000;
/// Longest piston travel, in micrometres.
pub const LONGEST_TRAVEL: i32 = 2_000_000;

const fn valve_range(word: usize) -> (i32, i32) {
    match word {
        0 => (2, MOST_POINTS),
        _ if word % 2 == 1 => (0, FLOW_LIMIT.0),
        _ => (0, CURRENT_LIMIT.0),
    }
}

const fn linkage_range(word: usize) -> (i32, i32) {
    match word {
        0 => (-FULL_TURN, FULL_TURN),
        1 => (1, FULL_TURN),
        _ => (-LONGEST_TRAVEL, LONGEST_TRAVEL),
    }
}

fn scalar_range(index: usize) -> Option<WordRange> {
    SCALARS.get(index).map(Scalar::range)
}

/// The first scalar of a block that is outside its range, with the name of its group. The block is not changed; a copy of it would
/// take its place on the stack.
pub(super) fn scalar_out_of_range(
    calibration: &mut Calibration,
) -> Option<(&'static str, OutOfRange)> {
    let mut tables_left = SCALARS_WORD;
    let mut scalars = (0..SCALAR_COUNT).zip(&SCALARS);
    let mut outside = None;
    calibration.for_each_word(&mut |word| {
        if tables_left > 0 {
            tables_left -= 1;
        } else if let Some((index, scalar)) = scalars.next()
            && !(scalar.min..=scalar.max).contains(word)
        {
            outside = outside.or(Some((index, *word)));
        }
    });
    outside.map(|(index, found)| {
        let (group, parameter) = description(index);
        (group, OutOfRange { parameter, found })
    })
}

/// Group and description of a scalar.
#[cfg(not(target_os = "none"))]
fn description(index: usize) -> (&'static str, &'static ParameterInfo) {
    let named = GROUPS
        .iter()
        .flat_map(|group| group.parameters.iter().map(|info| (group.name, info)));
    named.into_iter().nth(index).unwrap_or(("", &NAMELESS))
}

/// Nobody reads names on the ECU, where they would fill a tenth of the flash.
#[cfg(target_os = "none")]
fn description(_index: usize) -> (&'static str, &'static ParameterInfo) {
    ("", &NAMELESS)
}

const NAMELESS: ParameterInfo = ParameterInfo {
    name: "",
    suffix: "",
    counts_per_unit: 1,
    min: i32::MIN,
    max: i32::MAX,
    nominal: 0,
    class: Class::Machine,
    reason: "",
};

/// A stretch of words that belongs together, with a key that stays the same when the block's layout changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Item {
    /// Hash of names, unit and scale, 24 bits: what gets another unit is another item.
    pub key: u32,
    /// Its first word.
    pub first: usize,
    /// How many words it has, at most 255.
    pub count: u8,
    /// Whether it belongs to the safety block.
    pub is_safety: bool,
}

/// Number of items in a block.
pub const ITEM_COUNT: usize = TABLES.len() + SCALAR_COUNT;

/// Number of items in the safety block, a word each.
pub const SAFETY_ITEM_COUNT: usize = {
    let all = scalars();
    let (mut count, mut index) = (0, 0);
    while index < all.len() {
        count += all[index].class().is_safety() as usize;
        index += 1;
    }
    count
};

/// The items of a block in their order; version and checksum are none.
pub fn items() -> impl Iterator<Item = Item> + Clone {
    let scalars = (SCALARS_WORD..CALIBRATION_WORDS)
        .zip(&SCALARS)
        .map(|(first, scalar)| Item {
            key: scalar.key(),
            first,
            count: 1,
            is_safety: scalar.class().is_safety(),
        });
    TABLES.into_iter().chain(scalars)
}

const TABLES: [Item; 3] = [
    Item {
        key: key("lift", "current over flow", "a", 1_000),
        first: LIFT_WORD,
        count: VALVE_WORDS as u8,
        is_safety: false,
    },
    Item {
        key: key("lower", "current over flow", "a", 1_000),
        first: LOWER_WORD,
        count: VALVE_WORDS as u8,
        is_safety: false,
    },
    Item {
        key: key("linkage", "travel over angle", "mm", 1_000),
        first: LINKAGE_WORD,
        count: LINKAGE_WORDS as u8,
        is_safety: false,
    },
];

/// What the ECU itself needs of a scalar: names and reasons stay out of its flash.
#[derive(Clone, Copy)]
struct Scalar {
    /// Above the 24 bits of the key, the class: a byte of its own would take three more.
    key_and_class: u32,
    min: i32,
    max: i32,
}

impl Scalar {
    const KEY: u32 = (1 << 24) - 1;
    const MACHINE: u32 = 0 << 24;
    const LIVE: u32 = 1 << 24;
    const TIGHTER_UP: u32 = 2 << 24;
    const TIGHTER_DOWN: u32 = 3 << 24;
    const KEY_ONLY: u32 = 4 << 24;

    const fn new(key: u32, parameter: &ParameterInfo) -> Self {
        let class = match parameter.class {
            Class::Machine => Self::MACHINE,
            Class::Live => Self::LIVE,
            Class::Safety(Tightening::Up) => Self::TIGHTER_UP,
            Class::Safety(Tightening::Down) => Self::TIGHTER_DOWN,
            Class::Safety(Tightening::None) => Self::KEY_ONLY,
        };
        Self {
            key_and_class: key | class,
            min: parameter.min,
            max: parameter.max,
        }
    }

    const fn key(&self) -> u32 {
        self.key_and_class & Self::KEY
    }

    const fn class(&self) -> Class {
        match self.key_and_class & !Self::KEY {
            Self::LIVE => Class::Live,
            Self::TIGHTER_UP => Class::Safety(Tightening::Up),
            Self::TIGHTER_DOWN => Class::Safety(Tightening::Down),
            Self::KEY_ONLY => Class::Safety(Tightening::None),
            _ => Class::Machine,
        }
    }

    const fn range(&self) -> WordRange {
        WordRange {
            min: self.min,
            max: self.max,
            class: self.class(),
        }
    }
}

const SCALAR_COUNT: usize = CALIBRATION_WORDS - SCALARS_WORD - 1;

static SCALARS: [Scalar; SCALAR_COUNT] = scalars();

const fn scalars() -> [Scalar; SCALAR_COUNT] {
    let mut all = [Scalar::new(0, &NAMELESS); SCALAR_COUNT];
    let (mut next, mut of_group) = (0, 0);
    while of_group < GROUPS.len() {
        let group = GROUPS[of_group];
        let mut index = 0;
        while index < group.parameters.len() {
            let parameter = group.parameters[index];
            let key = key(
                group.name,
                parameter.name,
                parameter.suffix,
                parameter.counts_per_unit,
            );
            all[next] = Scalar::new(key, &parameter);
            next += 1;
            index += 1;
        }
        of_group += 1;
    }
    assert!(next == SCALAR_COUNT, "the groups don't fill the block");
    all
}

/// 24 bits from the name of a group, the name in it, the unit and the scale.
const fn key(group: &str, name: &str, unit: &str, scale: i32) -> u32 {
    let hash = fnv::text(full_name(group, name), unit);
    let hash = fnv::number(hash, scale);
    (hash >> 24) ^ (hash & 0xFF_FFFF)
}

/// A hash of the whole layout: equal only if every word means the same.
#[must_use]
pub const fn hash() -> u32 {
    let mut hash = fnv::number(fnv::START, CALIBRATION_WORDS as i32);
    let mut index = 0;
    while index < TABLES.len() {
        hash = fnv::number(hash, TABLES[index].key.cast_signed());
        index += 1;
    }
    let all = scalars();
    let mut index = 0;
    while index < all.len() {
        hash = fnv::number(hash, all[index].key().cast_signed());
        index += 1;
    }
    hash
}

impl Calibration {
    /// The block as words.
    #[must_use]
    pub fn to_words(&self) -> [i32; CALIBRATION_WORDS] {
        let mut words = [0; CALIBRATION_WORDS];
        let mut targets = words.iter_mut();
        self.clone().for_each_word(&mut |word| {
            if let Some(target) = targets.next() {
                *target = *word;
            }
        });
        words
    }

    /// Word `index`, if there is such a word.
    #[must_use]
    pub fn word(&self, index: usize) -> Option<i32> {
        match index {
            0 => Some(self.version.cast_signed()),
            LIFT_WORD..LOWER_WORD => valve_word(&self.lift, index.saturating_sub(LIFT_WORD)),
            LOWER_WORD..LINKAGE_WORD => valve_word(&self.lower, index.saturating_sub(LOWER_WORD)),
            LINKAGE_WORD..SCALARS_WORD => match index.saturating_sub(LINKAGE_WORD) {
                0 => Some(self.linkage.first_angle.0),
                1 => Some(self.linkage.angle_step.0),
                point => Some(self.linkage.travel.get(point.saturating_sub(2))?.0),
            },
            CHECKSUM_WORD => Some(self.checksum.cast_signed()),
            _ => self.scalar(index.checked_sub(SCALARS_WORD)?),
        }
    }

    /// The block of words; nothing of it is checked.
    #[must_use]
    pub fn from_words(words: &[i32; CALIBRATION_WORDS]) -> Self {
        let mut calibration = Self::unsealed_nominal();
        let mut sources = words.iter();
        calibration.for_each_word(&mut |word| {
            if let Some(source) = sources.next() {
                *word = *source;
            }
        });
        calibration
    }
}

/// Word `index` of a valve table.
fn valve_word(table: &ValveTable, index: usize) -> Option<i32> {
    let Some(value) = index.checked_sub(1) else {
        return Some(table.count.cast_signed());
    };
    let point = table.points.get(value / 2)?;
    Some(match value % 2 {
        0 => point.flow.0,
        _ => point.current.0,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_word_is_that_of_the_whole_block() {
        let block = Calibration::nominal();
        for (index, word) in block.to_words().into_iter().enumerate() {
            assert_eq!(block.word(index), Some(word), "{index}");
        }
        assert_eq!(block.word(CALIBRATION_WORDS), None);
    }
}
