//! Two copies in flash, each with a block of safety values and one of all others, and the steps in which a copy is
//! written.
//!
//! ```text
//!            begin                       all erased                 all written
//!   +------+ -----> +-------+ page by +---------+ chunk by +--------+ good: the other copy counts now
//!   | Idle |        | Erase | page    | Program | chunk    | Verify | bad: reported, the old one still counts
//!   +------+        +-------+ ------> +---------+ -------> +--------+
//! ```

use embedded_storage::nor_flash::NorFlash;
use hitch_quantities::ValidCalibration;
use hitch_quantities::calibration::calibration_words::CALIBRATION_WORDS;
use hitch_quantities::crc32::Crc32;

use super::copy_state::{BlockState, CopyState};
use super::layout::{
    CHUNK, CHUNK_WORDS, COPY_BYTES, Copy, SAFETY_CHUNKS, address, half_bytes, newest_first,
};
use super::reader::Reader;
use super::record;
use super::record::{Block, Carried};

/// Where a calibration came from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// From a copy.
    Stored {
        /// Which one.
        copy: usize,
        /// Version of the block in it; another one than this firmware's has been migrated.
        version: u32,
        /// What couldn't be carried over.
        carried: Carried,
    },
    /// No copy makes a calibration: this is the factory's, except for safety values that are stored.
    Factory,
}

/// Where the safety values came from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SafetySource {
    /// From a good block.
    Stored,
    /// None were ever stored, or a cut power ended the first storing: these are the factory's.
    Factory,
    /// They were stored, and no block of them is good any more. These are the factory's, which may be looser: nothing
    /// may move on them.
    Lost,
}

/// What was found at start.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Loaded {
    /// What to run on.
    pub calibration: ValidCalibration,
    /// Where it came from.
    pub source: Source,
    /// Where its safety values came from.
    pub safety: SafetySource,
    /// Both copies.
    pub copies: [Copy; 2],
}

/// Why storing failed. The calibration that was stored before is still there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StoreError<E> {
    /// The flash refused.
    Flash(E),
    /// The flash is too small for two copies.
    TooSmall,
    /// What was read back isn't what was written.
    Verify,
    /// Something is being stored already.
    Busy,
}

/// How far storing is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Progress {
    /// Nothing is being stored.
    Idle,
    /// There is more to do.
    Busy,
    /// Done: what was given to [`CalibrationStore::begin`] is what will be loaded.
    Done,
}

#[derive(Clone, Debug)]
enum Job {
    Erase { page: usize },
    Program { chunk: usize },
    Verify,
}

#[derive(Clone, Debug)]
struct Writing {
    job: Job,
    copy: usize,
    sequence: u32,
    safety_sequence: u32,
    words: [i32; CALIBRATION_WORDS],
    safety_checksum: u32,
    checksum: u32,
}

/// The copy whose calibration is in use.
#[derive(Clone, Copy, Debug)]
struct InUse {
    copy: usize,
    sequence: u32,
    safety_sequence: u32,
}

/// The store.
#[derive(Debug)]
pub struct CalibrationStore<F> {
    flash: F,
    /// The copy that the last [`Self::load`] found or the last storing completed. It is never erased.
    in_use: Option<InUse>,
    writing: Option<Writing>,
}

impl<F: NorFlash> CalibrationStore<F> {
    const CHUNK_FITS: () = assert!(
        CHUNK.is_multiple_of(F::WRITE_SIZE) && CHUNK.is_multiple_of(F::READ_SIZE),
        "flash that is read or programmed in larger pieces than a chunk"
    );

    /// A store on all of `flash`: the first half is one copy, the second half the other.
    #[must_use]
    pub const fn new(flash: F) -> Self {
        const { Self::CHUNK_FITS };
        Self {
            flash,
            in_use: None,
            writing: None,
        }
    }

    /// Gives the flash back.
    #[must_use]
    pub fn release(self) -> F {
        self.flash
    }

    /// What is stored: the newest copy that makes a calibration. A copy that can't be read counts as damaged.
    pub fn load(&mut self) -> Loaded {
        let states = self.states();
        let mut copies = states.map(|state| state.copy());
        self.in_use = None;
        for copy in newest_first(copies.map(|copy| copy.sequence())) {
            let state = states.get(copy).copied().unwrap_or_default();
            if let Ok(Some((calibration, source))) = self.decode(copy, state) {
                self.use_copy(copy, state);
                return Loaded {
                    calibration,
                    source,
                    safety: SafetySource::Stored,
                    copies,
                };
            }
            if let Some(useless) = copies.get_mut(copy) {
                *useless = Copy::Damaged;
            }
        }
        let (calibration, safety) = self.without_machine_block(states);
        Loaded {
            calibration,
            source: Source::Factory,
            safety,
            copies,
        }
    }

    /// The factory's calibration with the newest safety block, if there is a good one.
    fn without_machine_block(
        &mut self,
        states: [CopyState; 2],
    ) -> (ValidCalibration, SafetySource) {
        for copy in newest_first(states.map(|state| state.safety.sequence())) {
            let state = states.get(copy).copied().unwrap_or_default();
            let alone = state.without_machine();
            if let Ok(Some((calibration, _))) = self.decode(copy, alone) {
                self.use_copy(copy, alone);
                return (calibration, SafetySource::Stored);
            }
        }
        // A first storing that is cut leaves one copy blank, and no machine block, which is written last.
        let stored = states.iter().any(|state| state.machine.is_good())
            || !states.iter().any(CopyState::is_blank);
        let safety = if stored {
            SafetySource::Lost
        } else {
            SafetySource::Factory
        };
        (ValidCalibration::nominal(), safety)
    }

    fn use_copy(&mut self, copy: usize, state: CopyState) {
        self.in_use = Some(InUse {
            copy,
            sequence: state.machine.sequence().unwrap_or(0),
            safety_sequence: state.safety.sequence().unwrap_or(0),
        });
    }

    /// The number of the safety block in use: it rises with each storing. 0 without one.
    #[must_use]
    pub fn safety_sequence(&self) -> u32 {
        self.in_use.map_or(0, |used| used.safety_sequence)
    }

    /// Begins to store. The application then calls [`Self::step`] until it is done; the hitch has to be at rest,
    /// for many controllers stand still while a page is erased.
    ///
    /// # Errors
    /// If that can't be.
    pub fn begin(&mut self, calibration: &ValidCalibration) -> Result<(), StoreError<F::Error>> {
        if self.writing.is_some() {
            return Err(StoreError::Busy);
        }
        if half_bytes(&self.flash) < COPY_BYTES {
            return Err(StoreError::TooSmall);
        }
        if self.in_use.is_none() {
            self.load();
        }
        let (copy, sequence, safety_sequence) = match self.in_use {
            // The other copy is erased, so only this one's sequences have to be exceeded.
            Some(used) => (
                usize::from(used.copy == 0),
                used.sequence.wrapping_add(1),
                used.safety_sequence.wrapping_add(1),
            ),
            None => self.without_any(),
        };
        let words = calibration.to_words();
        self.writing = Some(Writing {
            job: Job::Erase { page: 0 },
            copy,
            sequence,
            safety_sequence,
            safety_checksum: checksum(Block::Safety.words(&words, safety_sequence)),
            checksum: checksum(Block::Machine.words(&words, sequence)),
            words,
        });
        Ok(())
    }

    /// Does the next step: erases a page, programs a chunk, or reads everything back.
    ///
    /// # Errors
    /// If it fails; then storing is over, and what was stored before still counts.
    pub fn step(&mut self) -> Result<Progress, StoreError<F::Error>> {
        let Some(mut writing) = self.writing.take() else {
            return Ok(Progress::Idle);
        };
        match self.advance(&mut writing)? {
            Some(job) => {
                writing.job = job;
                self.writing = Some(writing);
                Ok(Progress::Busy)
            }
            None => Ok(Progress::Done),
        }
    }

    /// Stores in one go, where nothing else has to be done meanwhile.
    ///
    /// # Errors
    /// If it fails; then what was stored before still counts.
    pub fn store(&mut self, calibration: &ValidCalibration) -> Result<(), StoreError<F::Error>> {
        self.begin(calibration)?;
        while self.step()? == Progress::Busy {}
        Ok(())
    }

    /// The job that comes next, `None` after the last.
    fn advance(&mut self, writing: &mut Writing) -> Result<Option<Job>, StoreError<F::Error>> {
        let start = self.copy_start(writing.copy);
        match writing.job {
            Job::Erase { page } => {
                let done = page.saturating_mul(F::ERASE_SIZE);
                let next = done.saturating_add(F::ERASE_SIZE);
                let (from, to) = (start.saturating_add(done), start.saturating_add(next));
                let erased = self.flash.erase(address(from), address(to));
                erased.map_err(StoreError::Flash)?;
                let more = next < COPY_BYTES;
                Ok(Some(if more {
                    Job::Erase {
                        page: page.saturating_add(1),
                    }
                } else {
                    Job::Program { chunk: 0 }
                }))
            }
            Job::Program { chunk } => {
                let bytes = chunk_bytes(writing, chunk);
                let done = chunk.saturating_mul(CHUNK);
                let at = address(start.saturating_add(done));
                self.flash.write(at, &bytes).map_err(StoreError::Flash)?;
                let more = done.saturating_add(CHUNK) < COPY_BYTES;
                Ok(Some(if more {
                    Job::Program {
                        chunk: chunk.saturating_add(1),
                    }
                } else {
                    Job::Verify
                }))
            }
            Job::Verify => {
                let state = self.examine(writing.copy).map_err(StoreError::Flash)?;
                let good = state.machine.sequence() == Some(writing.sequence)
                    && state.safety.sequence() == Some(writing.safety_sequence);
                if !good {
                    return Err(StoreError::Verify);
                }
                self.use_copy(writing.copy, state);
                Ok(None)
            }
        }
    }

    /// Where to store, and under which numbers, if no copy makes a calibration: over a damaged copy before another one,
    /// for it may be one that could be read again later. The numbers exceed those of the copy that stays.
    fn without_any(&mut self) -> (usize, u32, u32) {
        let [first, second] = self.states();
        let is_damaged = |state: &CopyState| state.copy() == Copy::Damaged;
        let (copy, stays) = if is_damaged(&second) && !is_damaged(&first) {
            (1, first)
        } else {
            (0, second)
        };
        let after = |block: BlockState| block.sequence().unwrap_or(0).wrapping_add(1);
        (copy, after(stays.machine), after(stays.safety))
    }

    fn states(&mut self) -> [CopyState; 2] {
        [0, 1].map(|copy| self.examine(copy).unwrap_or_default())
    }

    /// What a copy is worth, by its checksums.
    fn examine(&mut self, copy: usize) -> Result<CopyState, F::Error> {
        let (start, end) = self.copy_range(copy);
        CopyState::examine(&mut self.flash, start, end)
    }

    /// The calibration in the good blocks of a copy, if they make one.
    fn decode(
        &mut self,
        copy: usize,
        state: CopyState,
    ) -> Result<Option<(ValidCalibration, Source)>, F::Error> {
        let (start, end) = self.copy_range(copy);
        let mut block = record::factory();
        let mut version = 0;
        for place in state.places().into_iter().flatten() {
            let mut reader = Reader::new(&mut self.flash, start.saturating_add(place), end);
            let Some((header, rest)) = reader.record()? else {
                return Ok(None);
            };
            version = header.version;
            let mut failed = None;
            let entries =
                (0..rest).map_while(|_| reader.word().map_err(|error| failed = Some(error)).ok());
            block.take_entries(entries);
            if let Some(error) = failed {
                return Err(error);
            }
        }
        Ok(block.finish().map(|(calibration, carried)| {
            let source = Source::Stored {
                copy,
                version,
                carried,
            };
            (calibration, source)
        }))
    }

    fn copy_start(&self, copy: usize) -> usize {
        copy.saturating_mul(half_bytes(&self.flash))
    }

    fn copy_range(&self, copy: usize) -> (usize, usize) {
        let start = self.copy_start(copy);
        (start, start.saturating_add(half_bytes(&self.flash)))
    }
}

fn checksum(words: impl Iterator<Item = u32>) -> u32 {
    let mut digest = Crc32::default();
    words.for_each(|word| digest.update(&word.to_le_bytes()));
    digest.value()
}

/// A chunk of the copy, the last one of each block filled up with what erased flash holds.
fn chunk_bytes(writing: &Writing, chunk: usize) -> [u8; CHUNK] {
    match chunk.checked_sub(SAFETY_CHUNKS) {
        None => chunk_of(
            Block::Safety.words(&writing.words, writing.safety_sequence),
            writing.safety_checksum,
            chunk,
        ),
        Some(chunk) => chunk_of(
            Block::Machine.words(&writing.words, writing.sequence),
            writing.checksum,
            chunk,
        ),
    }
}

fn chunk_of(words: impl Iterator<Item = u32>, checksum: u32, chunk: usize) -> [u8; CHUNK] {
    let mut bytes = [u8::MAX; CHUNK];
    let (targets, _) = bytes.as_chunks_mut::<4>();
    let first = chunk.saturating_mul(CHUNK_WORDS);
    for (index, word) in (0..usize::MAX).zip(words.chain([checksum])) {
        let place = index.checked_sub(first);
        if let Some(target) = place.and_then(|place| targets.get_mut(place)) {
            *target = word.to_le_bytes();
        }
    }
    bytes
}
