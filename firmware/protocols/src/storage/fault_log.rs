//! The log of faults in flash: what is appended outlives the power, and a power cut loses at most the newest entry.
//!
//! Two pages, of which the newer one counts. A page is a row of slots of eight bytes, each programmed once:
//!
//! ```text
//! slot 0      sequence (4 bytes)                                    CRC-32 of "HFLT" and sequence
//! slots 1..   SPN low, SPN high, SPN bits 18..16 and FMI, count     CRC-32 of sequence and these four bytes
//! ```
//!
//! For each code the last entry counts; a count of zero means that the code was cleared. A slot whose check fails was torn by a
//! power cut: it is skipped and never programmed again. When the room gets short, the last entries go to the other page,
//! whose first slot is programmed last: until then the old page counts. The sequence is part of each check, so an entry
//! that an interrupted erasing left behind is never taken for one of the new page.

use embedded_storage::nor_flash::NorFlash;
use hitch_quantities::crc32::Crc32;

use super::layout::{address, half_bytes, newest_first};
use crate::j1939::trouble::Code;

/// Bytes of a slot: what the coarser of both parts' flash programs at a time, with its error correction.
const SLOT_BYTES: usize = 8;
/// Slots of a page, if the flash is large enough.
pub const MOST_SLOTS: usize = 256;

type Slot = [u8; SLOT_BYTES];

/// What erased flash holds.
const BLANK: Slot = [u8::MAX; SLOT_BYTES];

/// A fault and how often it has occurred.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    /// Which fault.
    pub code: Code,
    /// Occurrences; 0: cleared.
    pub count: u8,
}

impl Entry {
    fn to_slot(self, sequence: u32) -> Slot {
        let [low, high, highest, _] = self.code.spn.to_le_bytes();
        let mode = (highest << 5) | (self.code.fmi & 0x1F);
        slot([low, high, mode, self.count], &sequence.to_le_bytes())
    }

    fn from_slot(found: Slot, sequence: u32) -> Option<Self> {
        let [low, high, mode, count, ..] = found;
        let expected = slot([low, high, mode, count], &sequence.to_le_bytes());
        let code = Code {
            spn: u32::from_le_bytes([low, high, mode >> 5, 0]),
            fmi: mode & 0x1F,
        };
        (found == expected).then_some(Self { code, count })
    }
}

/// The first slot of a page.
fn head(sequence: u32) -> Slot {
    slot(sequence.to_le_bytes(), b"HFLT")
}

/// Four bytes and the check of `salt` and these.
fn slot(bytes: [u8; 4], salt: &[u8; 4]) -> Slot {
    let [a, b, c, d] = bytes;
    let mut digest = Crc32::default();
    digest.update(salt);
    digest.update(&bytes);
    let [e, f, g, h] = digest.value().to_le_bytes();
    [a, b, c, d, e, f, g, h]
}

/// Why an entry was not stored. What was stored before still counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LogError {
    /// There is no slot left until the log is compacted.
    Full,
    /// The flash refused, or what was read back is not what was written.
    Flash,
}

/// The log.
#[derive(Debug)]
pub struct FaultLog<F> {
    flash: F,
    /// The page that counts.
    page: usize,
    sequence: u32,
    /// The next slot to program; 0 if the page has no first slot yet.
    next: usize,
}

impl<F: NorFlash> FaultLog<F> {
    const SLOT_FITS: () = assert!(
        SLOT_BYTES.is_multiple_of(F::WRITE_SIZE) && SLOT_BYTES.is_multiple_of(F::READ_SIZE),
        "flash that is read or programmed in larger pieces than a slot"
    );

    /// The log on all of `flash`: the first half is one page, the second half the other. Erases a page only if neither
    /// counts and the first one is not blank.
    #[must_use]
    pub fn open(flash: F) -> Self {
        const { Self::SLOT_FITS };
        let mut log = Self {
            flash,
            page: 0,
            sequence: 0,
            next: 0,
        };
        match log.newest() {
            Some((page, sequence)) => {
                (log.page, log.sequence) = (page, sequence);
                log.next = log.used();
            }
            None if log.used() == 0 => {}
            None => {
                if log.erase(0).is_err() {
                    log.next = log.slots();
                }
            }
        }
        log
    }

    /// All entries that are whole, the oldest first.
    pub fn entries(&mut self) -> impl Iterator<Item = Entry> + '_ {
        (1..self.next.min(self.slots())).filter_map(|index| {
            let found = self.read(self.page, index).ok()?;
            Entry::from_slot(found, self.sequence)
        })
    }

    /// Entries that [`Self::append`] still takes.
    #[must_use]
    pub fn room(&self) -> usize {
        self.slots().saturating_sub(self.next.max(1))
    }

    /// Appends an entry; a page without its first slot gets that before.
    ///
    /// # Errors
    /// If the entry is not stored; its slot is skipped then.
    pub fn append(&mut self, entry: Entry) -> Result<(), LogError> {
        if self.room() == 0 {
            return Err(LogError::Full);
        }
        if self.next == 0 {
            if let Err(error) = self.program(self.page, 0, head(self.sequence)) {
                // Without it no entry would be found: nothing more is stored until the next start erases the page.
                self.next = self.slots();
                return Err(error);
            }
            self.next = 1;
        }
        let index = self.next;
        self.next = index.saturating_add(1);
        self.program(self.page, index, entry.to_slot(self.sequence))
    }

    /// Moves to the other page, which gets these entries. The processor may stand still for seconds meanwhile.
    ///
    /// # Errors
    /// If that fails; the old page then still counts.
    pub fn compact(&mut self, entries: impl Iterator<Item = Entry>) -> Result<(), LogError> {
        let page = usize::from(self.page == 0);
        let sequence = self.sequence.wrapping_add(1);
        self.erase(page)?;
        let mut next = 1_usize;
        for entry in entries {
            if next >= self.slots() {
                return Err(LogError::Full);
            }
            self.program(page, next, entry.to_slot(sequence))?;
            next = next.saturating_add(1);
        }
        self.program(page, 0, head(sequence))?;
        (self.page, self.sequence, self.next) = (page, sequence, next);
        Ok(())
    }

    /// The page that counts, and its sequence.
    fn newest(&mut self) -> Option<(usize, u32)> {
        let sequences = [0, 1].map(|page| self.sequence_of(page));
        let page = newest_first(sequences).next()?;
        Some((page, sequences.into_iter().nth(page)??))
    }

    fn sequence_of(&mut self, page: usize) -> Option<u32> {
        if self.slots() == 0 {
            return None;
        }
        let found = self.read(page, 0).ok()?;
        let [a, b, c, d, ..] = found;
        let sequence = u32::from_le_bytes([a, b, c, d]);
        (found == head(sequence)).then_some(sequence)
    }

    /// Slots up to the last one that is not blank. One that can't be read isn't.
    fn used(&mut self) -> usize {
        let last = (0..self.slots())
            .rev()
            .find(|&index| self.read(self.page, index) != Ok(BLANK));
        last.map_or(0, |last| last.saturating_add(1))
    }

    fn read(&mut self, page: usize, index: usize) -> Result<Slot, LogError> {
        let mut slot = BLANK;
        let at = self.slot_address(page, index);
        match self.flash.read(at, &mut slot) {
            Ok(()) => Ok(slot),
            Err(_) => Err(LogError::Flash),
        }
    }

    fn program(&mut self, page: usize, index: usize, slot: Slot) -> Result<(), LogError> {
        let at = self.slot_address(page, index);
        let written = self.flash.write(at, &slot);
        if written.is_ok() && self.read(page, index) == Ok(slot) {
            Ok(())
        } else {
            Err(LogError::Flash)
        }
    }

    /// Erases as much of a page as its slots take.
    fn erase(&mut self, page: usize) -> Result<(), LogError> {
        let bytes = self.slots().saturating_mul(SLOT_BYTES);
        let start = page.saturating_mul(half_bytes(&self.flash));
        let mut done = 0_usize;
        while done < bytes {
            let from = start.saturating_add(done);
            let to = from.saturating_add(F::ERASE_SIZE);
            let erased = self.flash.erase(address(from), address(to));
            erased.map_err(|_| LogError::Flash)?;
            done = done.saturating_add(F::ERASE_SIZE);
        }
        Ok(())
    }

    fn slots(&self) -> usize {
        MOST_SLOTS.min(half_bytes(&self.flash) / SLOT_BYTES)
    }

    fn slot_address(&self, page: usize, index: usize) -> u32 {
        let start = page.saturating_mul(half_bytes(&self.flash));
        address(start.saturating_add(index.saturating_mul(SLOT_BYTES)))
    }
}
