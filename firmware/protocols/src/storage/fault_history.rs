//! Which trouble codes are kept over a power cut, and when they are written.
//!
//! The node counts how often each code has occurred. The log is compared with these counts, and one entry at a time is
//! appended for a code whose logged count is out of date. A code is
//! written when it occurs for the first time since the start or since it was cleared, and when it is cleared (DM3). Further
//! occurrences in the same start are not counted in flash.
//!
//! # Endurance
//!
//! A start writes at most [`MOST_WRITES`] entries, so a bus that clears the codes again and again doesn't wear the flash
//! out; what comes after these is lost at power-off. A count ends at 126, and so does the writing of a code that occurs at
//! each start. The log is compacted only at the start, if fewer slots are free than these writes need: that takes at least
//! [`WRITES_PER_ERASE`] entries, and each page is erased every other time. Flash that can be erased 10 000 times (data
//! sheets of both parts) so takes 1.8 million entries, 16 000 starts with the most writes: more than four a day in ten years.

use embedded_storage::nor_flash::NorFlash;

use super::fault_log::{Entry, FaultLog, MOST_SLOTS};
use crate::j1939::diagnostics::{KINDS, Occurrences};
use crate::j1939::{Trouble, Troubles};

/// Entries that a start writes at most: each code occurs and is cleared.
pub const MOST_WRITES: usize = 2 * KINDS;
/// Entries from one compaction to the next, at least: the page's first slot and an entry of each code are copied.
pub const WRITES_PER_ERASE: usize = MOST_SLOTS - 1 - KINDS - MOST_WRITES + 1;

/// Starts with the most writes that two pages of 10 000 erases take.
const STARTS: usize = 2 * 10_000 * WRITES_PER_ERASE / MOST_WRITES;

const _: () = assert!(STARTS >= 4 * 3_653, "a page too small for its use");

/// The trouble codes in flash.
#[derive(Debug)]
pub struct FaultHistory<F> {
    log: FaultLog<F>,
    /// Occurrences as the log has them.
    stored: Occurrences,
    /// Codes that were written since the start or since they were cleared.
    written: Troubles,
    writes_left: usize,
}

impl<F: NorFlash> FaultHistory<F> {
    /// Reads the log, and compacts it if fewer slots are free than this start may write. Both coils have to be off.
    pub fn open(flash: F) -> Self {
        let mut history = Self {
            log: FaultLog::open(flash),
            stored: [0; KINDS],
            written: Troubles::NONE,
            writes_left: MOST_WRITES,
        };
        for entry in history.log.entries() {
            let known = Trouble::ALL
                .iter()
                .find(|trouble| trouble.code() == entry.code);
            if let Some(count) = known.and_then(|&known| history.stored.get_mut(known as usize)) {
                *count = entry.count;
            }
        }
        if history.log.room() < MOST_WRITES {
            let stored = history.stored;
            let kept = Trouble::ALL.iter().filter_map(|&trouble| {
                let count = *stored.get(trouble as usize)?;
                (count > 0).then_some(entry(trouble, count))
            });
            // If that fails, entries go to the old page as long as it has room.
            let _ = history.log.compact(kept);
        }
        history
    }

    /// How often each code has occurred, as the log has it.
    #[must_use]
    pub const fn stored(&self) -> &Occurrences {
        &self.stored
    }

    /// Appends one entry for a code whose logged count is out of date, if there is one. Returns whether flash was
    /// programmed, which takes 0.2 ms at most. Both coils have to be off, and the supply has to be good.
    pub fn update(&mut self, occurrences: &Occurrences) -> bool {
        if self.writes_left == 0 {
            return false;
        }
        let lacking = Trouble::ALL
            .iter()
            .copied()
            .find(|&trouble| self.lacks(trouble, occurrences));
        let Some(trouble) = lacking else {
            return false;
        };
        let count = occurrences.get(trouble as usize).copied().unwrap_or(0);
        self.writes_left = self.writes_left.saturating_sub(1);
        if self.log.append(entry(trouble, count)).is_ok() {
            if let Some(stored) = self.stored.get_mut(trouble as usize) {
                *stored = count;
            }
            self.written = match count {
                0 => self.written.without(trouble.into()),
                _ => self.written.union(trouble.into()),
            };
        }
        true
    }

    fn lacks(&self, trouble: Trouble, occurrences: &Occurrences) -> bool {
        let of = |counts: &Occurrences| counts.get(trouble as usize).copied().unwrap_or(0);
        let (stored, count) = (of(&self.stored), of(occurrences));
        if count < stored {
            true
        } else {
            count > stored && !self.written.contains(trouble)
        }
    }
}

const fn entry(trouble: Trouble, count: u8) -> Entry {
    Entry {
        code: trouble.code(),
        count,
    }
}
