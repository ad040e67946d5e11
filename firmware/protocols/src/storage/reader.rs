//! Reading a record from flash, word by word.

use embedded_storage::nor_flash::NorFlash;

use super::layout::{CHUNK, CHUNK_WORDS, address};
use super::record::{HEADER_WORDS, Header};

/// Reads a record word by word.
pub(super) struct Reader<'a, F> {
    flash: &'a mut F,
    at: usize,
    end: usize,
    chunk: [u8; CHUNK],
    /// The next word in the chunk.
    next: usize,
}

impl<'a, F: NorFlash> Reader<'a, F> {
    /// A reader of what is between two offsets of the flash.
    pub(super) const fn new(flash: &'a mut F, at: usize, end: usize) -> Self {
        Self {
            flash,
            at,
            end,
            chunk: [0; CHUNK],
            next: CHUNK_WORDS,
        }
    }

    pub(super) fn header_words(&mut self) -> Result<[u32; HEADER_WORDS], F::Error> {
        let mut words = [0; HEADER_WORDS];
        for word in &mut words {
            *word = self.word()?;
        }
        Ok(words)
    }

    /// The header of a record, and the number of words between it and the checksum.
    pub(super) fn record(&mut self) -> Result<Option<(Header, usize)>, F::Error> {
        let first = self.header_words()?;
        Ok(self.record_after(first))
    }

    /// The same of a header that has been read, if the record fits into the copy.
    pub(super) fn record_after(&self, first: [u32; HEADER_WORDS]) -> Option<(Header, usize)> {
        let header = Header::from_words(first)?;
        let words = usize::try_from(header.words).ok()?;
        // The first chunk has been read already.
        let room = self.end.saturating_sub(self.at).saturating_add(CHUNK) / 4;
        let fits = words <= room;
        let rest = words.checked_sub(HEADER_WORDS + 1).filter(|_| fits)?;
        Some((header, rest))
    }

    /// The next word; an erased one beyond the end.
    pub(super) fn word(&mut self) -> Result<u32, F::Error> {
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
