//! Two copies in flash, and the steps in which one of them is written.
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

use super::record;
use super::record::{Carried, HEADER_WORDS, Header, RECORD_WORDS};

/// Bytes that are read or programmed at a time: a multiple of what any flash takes at once.
const CHUNK: usize = 32;
const CHUNK_WORDS: usize = CHUNK / 4;
/// Bytes that a record of this firmware takes, the last chunk filled up.
const RECORD_BYTES: usize = (4 * RECORD_WORDS).next_multiple_of(CHUNK);

/// One of the two copies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Copy {
    /// Complete.
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
    const fn sequence(&self) -> Option<u32> {
        match *self {
            Self::Good { sequence } => Some(sequence),
            Self::Blank | Self::Damaged => None,
        }
    }
}

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
    /// No copy makes a calibration: this is the factory's.
    Factory,
}

/// What was found at start.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Loaded {
    /// What to run on.
    pub calibration: ValidCalibration,
    /// Where it came from.
    pub source: Source,
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
    words: [i32; CALIBRATION_WORDS],
    checksum: u32,
}

/// The copy whose calibration is in use.
#[derive(Clone, Copy, Debug)]
struct InUse {
    copy: usize,
    sequence: u32,
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
        let mut copies = self.copies();
        self.in_use = None;
        for copy in newest_first(copies) {
            let sequence = copies.get(copy).and_then(|copy| copy.sequence());
            let decoded = self.decode(copy).ok().flatten();
            if let (Some((calibration, source)), Some(sequence)) = (decoded, sequence) {
                self.in_use = Some(InUse { copy, sequence });
                return Loaded {
                    calibration,
                    source,
                    copies,
                };
            }
            if let Some(useless) = copies.get_mut(copy) {
                *useless = Copy::Damaged;
            }
        }
        Loaded {
            calibration: ValidCalibration::nominal(),
            source: Source::Factory,
            copies,
        }
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
        if self.copy_bytes() < RECORD_BYTES {
            return Err(StoreError::TooSmall);
        }
        if self.in_use.is_none() {
            self.load();
        }
        let (copy, sequence) = match self.in_use {
            // The other copy is erased, so only this one's sequence has to be exceeded.
            Some(InUse { copy, sequence }) => (usize::from(copy == 0), sequence.wrapping_add(1)),
            None => self.without_any(),
        };
        let words = calibration.to_words();
        self.writing = Some(Writing {
            job: Job::Erase { page: 0 },
            copy,
            sequence,
            checksum: checksum(record::words(&words, sequence)),
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
                let more = next < RECORD_BYTES;
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
                let more = done.saturating_add(CHUNK) < RECORD_BYTES;
                Ok(Some(if more {
                    Job::Program {
                        chunk: chunk.saturating_add(1),
                    }
                } else {
                    Job::Verify
                }))
            }
            Job::Verify => match self.examine(writing.copy).map_err(StoreError::Flash)? {
                Copy::Good { sequence } if sequence == writing.sequence => {
                    let copy = writing.copy;
                    self.in_use = Some(InUse { copy, sequence });
                    Ok(None)
                }
                _ => Err(StoreError::Verify),
            },
        }
    }

    /// Where to store, and under which number, if no copy makes a calibration: over a damaged copy before another one,
    /// for it may be one that could be read again later. The number exceeds that of the copy that stays.
    fn without_any(&mut self) -> (usize, u32) {
        let [first, second] = self.copies();
        let (copy, stays) = match second == Copy::Damaged && first != Copy::Damaged {
            true => (1, first),
            false => (0, second),
        };
        (copy, stays.sequence().unwrap_or(0).wrapping_add(1))
    }

    fn copies(&mut self) -> [Copy; 2] {
        [0, 1].map(|copy| self.examine(copy).unwrap_or(Copy::Damaged))
    }

    /// What a copy is worth, by its checksum.
    fn examine(&mut self, copy: usize) -> Result<Copy, F::Error> {
        let mut reader = self.reader(copy);
        let first = reader.header()?;
        let Some(header) = Header::from_words(first) else {
            let blank = first.iter().all(|&word| word == u32::MAX);
            return Ok(if blank { Copy::Blank } else { Copy::Damaged });
        };
        let Some(rest) = reader.entries(&header) else {
            return Ok(Copy::Damaged);
        };
        let mut digest = Crc32::default();
        first
            .iter()
            .for_each(|word| digest.update(&word.to_le_bytes()));
        for _ in 0..rest {
            digest.update(&reader.word()?.to_le_bytes());
        }
        Ok(if reader.word()? == digest.value() {
            Copy::Good {
                sequence: header.sequence,
            }
        } else {
            Copy::Damaged
        })
    }

    /// The calibration in a good copy, if it makes one.
    fn decode(&mut self, copy: usize) -> Result<Option<(ValidCalibration, Source)>, F::Error> {
        let mut reader = self.reader(copy);
        let header = Header::from_words(reader.header()?);
        let Some((header, rest)) =
            header.and_then(|header| Some((header, reader.entries(&header)?)))
        else {
            return Ok(None);
        };
        let mut failed = None;
        let entries =
            (0..rest).map_while(|_| reader.word().map_err(|error| failed = Some(error)).ok());
        let decoded = record::decode(entries);
        if let Some(error) = failed {
            return Err(error);
        }
        Ok(decoded.map(|(calibration, carried)| {
            let source = Source::Stored {
                copy,
                version: header.version,
                carried,
            };
            (calibration, source)
        }))
    }

    /// Size of a copy: half of the flash, in whole pages.
    fn copy_bytes(&self) -> usize {
        let half = self.flash.capacity() / 2;
        half.saturating_sub(half % F::ERASE_SIZE)
    }

    fn copy_start(&self, copy: usize) -> usize {
        copy.saturating_mul(self.copy_bytes())
    }

    fn reader(&mut self, copy: usize) -> Reader<'_, F> {
        let at = self.copy_start(copy);
        let end = at.saturating_add(self.copy_bytes());
        Reader {
            flash: &mut self.flash,
            at,
            end,
            chunk: [0; CHUNK],
            next: CHUNK_WORDS,
        }
    }
}

/// Reads a copy word by word.
struct Reader<'a, F> {
    flash: &'a mut F,
    at: usize,
    end: usize,
    chunk: [u8; CHUNK],
    /// The next word in the chunk.
    next: usize,
}

impl<F: NorFlash> Reader<'_, F> {
    fn header(&mut self) -> Result<[u32; HEADER_WORDS], F::Error> {
        let mut words = [0; HEADER_WORDS];
        for word in &mut words {
            *word = self.word()?;
        }
        Ok(words)
    }

    /// Words between header and checksum, if the record fits into the copy.
    fn entries(&self, header: &Header) -> Option<usize> {
        let words = usize::try_from(header.words).ok()?;
        // The first chunk has been read already.
        let room = self.end.saturating_sub(self.at).saturating_add(CHUNK) / 4;
        let fits = words <= room;
        words.checked_sub(HEADER_WORDS + 1).filter(|_| fits)
    }

    /// The next word; an erased one beyond the end.
    fn word(&mut self) -> Result<u32, F::Error> {
        if self.next >= CHUNK_WORDS {
            let next = self.at.saturating_add(CHUNK);
            if next > self.end {
                return Ok(u32::MAX);
            }
            self.flash.read(address(self.at), &mut self.chunk)?;
            self.at = next;
            self.next = 0;
        }
        let (words, _) = self.chunk.as_chunks::<4>();
        let word = words.get(self.next).copied().unwrap_or([u8::MAX; 4]);
        self.next = self.next.saturating_add(1);
        Ok(u32::from_le_bytes(word))
    }
}

/// The good copies, the newer one first.
fn newest_first(copies: [Copy; 2]) -> impl Iterator<Item = usize> {
    let order = match copies {
        [
            Copy::Good { sequence: first },
            Copy::Good { sequence: second },
        ] => {
            // Sequences wrap; of two that were stored one after the other, the later one is one further on.
            if first.wrapping_sub(second).cast_signed() >= 0 {
                [Some(0), Some(1)]
            } else {
                [Some(1), Some(0)]
            }
        }
        [Copy::Good { .. }, _] => [Some(0), None],
        [_, Copy::Good { .. }] => [Some(1), None],
        _ => [None, None],
    };
    order.into_iter().flatten()
}

fn checksum(words: impl Iterator<Item = u32>) -> u32 {
    let mut digest = Crc32::default();
    words.for_each(|word| digest.update(&word.to_le_bytes()));
    digest.value()
}

/// A chunk of the record, the last one filled up with what erased flash holds.
fn chunk_bytes(writing: &Writing, chunk: usize) -> [u8; CHUNK] {
    let mut bytes = [u8::MAX; CHUNK];
    let all = record::words(&writing.words, writing.sequence).chain([writing.checksum]);
    let (targets, _) = bytes.as_chunks_mut::<4>();
    let first = chunk.saturating_mul(CHUNK_WORDS);
    for (index, word) in (0..RECORD_WORDS).zip(all) {
        let place = index.checked_sub(first);
        if let Some(target) = place.and_then(|place| targets.get_mut(place)) {
            *target = word.to_le_bytes();
        }
    }
    bytes
}

/// Flash is addressed with 32 bits.
fn address(offset: usize) -> u32 {
    u32::try_from(offset).unwrap_or(u32::MAX)
}
