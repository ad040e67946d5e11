//! The two pages of the calibration: what a tool is working on, in RAM, and what is stored.
//!
//! A tool writes word by word, so a page may be inconsistent for a while: a curve that doesn't rise, a lower limit
//! above the upper. The controller gets a page only as a whole and only validated; until then it keeps what it had.

use hitch_quantities::calibration::calibration_words::{CALIBRATION_WORDS, WordRange, word_range};
use hitch_quantities::{Calibration, CalibrationError, ValidCalibration};

use super::error::Refusal;
use super::memory::Page;

/// What became of the last change.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum Applied {
    /// The controller has it.
    #[default]
    InUse = 0,
    /// There is one that the controller hasn't been given yet.
    Pending = 1,
    /// The page is inconsistent; the controller keeps what it had.
    Inconsistent = 2,
}

/// Bytes of a word.
const WORD_BYTES: usize = 4;
/// Most bytes that one command writes.
const LONGEST_PIECE: usize = 7;

/// The beginning of a word whose end hasn't come yet.
#[derive(Clone, Copy, Debug, Default)]
struct Fragment {
    word: usize,
    bytes: [u8; WORD_BYTES - 1],
    length: usize,
}

impl Fragment {
    fn new(word: usize, beginning: &[u8]) -> Self {
        let mut bytes = [0; WORD_BYTES - 1];
        for (target, byte) in bytes.iter_mut().zip(beginning) {
            *target = *byte;
        }
        Self {
            word,
            bytes,
            length: beginning.len().min(WORD_BYTES - 1),
        }
    }

    /// Offset of the byte that is missing next.
    fn end(&self) -> usize {
        self.word
            .saturating_mul(WORD_BYTES)
            .saturating_add(self.length)
    }

    /// What there is of the word, and `bytes` behind it, in `room`.
    fn followed_by<'a>(&self, bytes: &[u8], room: &'a mut [u8]) -> Result<&'a [u8], Refusal> {
        let length = self.length.saturating_add(bytes.len());
        let room = room.get_mut(..length).ok_or(Refusal::OutOfRange)?;
        let known = self.bytes.iter().take(self.length);
        for (target, byte) in room.iter_mut().zip(known.chain(bytes)) {
            *target = *byte;
        }
        Ok(room)
    }
}

/// Both pages, as words in the order of the block's image.
#[derive(Clone, Debug)]
pub struct CalibrationPages {
    working: [i32; CALIBRATION_WORDS],
    reference: [i32; CALIBRATION_WORDS],
    controller_page: Page,
    tool_page: Page,
    applied: Applied,
    fragment: Fragment,
}

impl CalibrationPages {
    /// Both pages hold what is stored.
    #[must_use]
    pub fn new(stored: &ValidCalibration) -> Self {
        let words = stored.to_words();
        Self {
            working: words,
            reference: words,
            controller_page: Page::Working,
            tool_page: Page::Working,
            applied: Applied::InUse,
            fragment: Fragment::default(),
        }
    }

    /// The calibration that the controller should have from now on, once after each change that makes one.
    ///
    /// # Errors
    /// What is inconsistent, once: the controller keeps what it had.
    pub fn take_change(&mut self) -> Option<Result<ValidCalibration, CalibrationError>> {
        if self.applied != Applied::Pending {
            return None;
        }
        let checked = Calibration::from_words(self.page(self.controller_page)).seal();
        self.applied = match checked {
            Ok(_) => Applied::InUse,
            Err(_) => Applied::Inconsistent,
        };
        Some(checked)
    }

    /// What became of the last change.
    #[must_use]
    pub const fn applied(&self) -> Applied {
        self.applied
    }

    /// The working page, to be stored.
    ///
    /// # Errors
    /// If it is inconsistent.
    pub fn to_store(&self) -> Result<ValidCalibration, CalibrationError> {
        Calibration::from_words(&self.working).seal()
    }

    /// `stored` is in flash now: the reference page is it.
    pub fn stored(&mut self, stored: &ValidCalibration) {
        self.reference = stored.to_words();
        if self.controller_page == Page::Reference {
            self.applied = Applied::Pending;
        }
    }

    /// Replaces the working page, as after teaching.
    pub fn replace_working(&mut self, calibration: &ValidCalibration) {
        self.working = calibration.to_words();
        self.changed(Page::Working);
    }

    /// A word of the page that tools see.
    #[must_use]
    pub fn word(&self, index: usize) -> Option<i32> {
        self.page(self.tool_page).get(index).copied()
    }

    /// Writes bytes of the block from `offset` on; `moving`: only what may be changed while the hitch moves.
    ///
    /// A word is checked and changed as a whole. Tools write what doesn't fit one message in pieces of six or seven
    /// bytes, so a piece may end inside a word; what there is of it waits for the next piece to complete it. A piece
    /// that begins inside a word and doesn't go on where the last one ended is refused.
    ///
    /// # Errors
    /// Why not; then nothing was changed.
    pub fn write(&mut self, offset: usize, bytes: &[u8], moving: bool) -> Result<(), Refusal> {
        if self.tool_page != Page::Working {
            return Err(Refusal::WriteProtected);
        }
        let begun = core::mem::take(&mut self.fragment);
        let begun = match offset.is_multiple_of(WORD_BYTES) {
            true => Fragment::default(),
            false if offset == begun.end() => begun,
            false => return Err(Refusal::AccessDenied),
        };
        let mut piece = [0; WORD_BYTES - 1 + LONGEST_PIECE];
        let piece = begun.followed_by(bytes, &mut piece)?;
        let first = offset / WORD_BYTES;
        let (words, rest) = piece.as_chunks::<WORD_BYTES>();
        let words = words.iter().map(|word| i32::from_le_bytes(*word));
        let indexed = (first..=usize::MAX).zip(words);
        for (index, value) in indexed.clone() {
            check(index, value, moving)?;
        }
        if !rest.is_empty() {
            let word = first.saturating_add(piece.len() / WORD_BYTES);
            check_place(word, moving)?;
            self.fragment = Fragment::new(word, rest);
        }
        for (index, value) in indexed {
            self.set(index, value);
        }
        Ok(())
    }

    fn set(&mut self, index: usize, value: i32) {
        if let Some(word) = self.working.get_mut(index) {
            *word = value;
            self.changed(Page::Working);
        }
    }

    /// The page that tools see.
    #[must_use]
    pub const fn tool_page(&self) -> Page {
        self.tool_page
    }

    /// The page that the controller runs on.
    #[must_use]
    pub const fn controller_page(&self) -> Page {
        self.controller_page
    }

    /// Chooses the page that tools see.
    pub const fn set_tool_page(&mut self, page: Page) {
        self.tool_page = page;
    }

    /// Chooses the page that the controller runs on.
    pub fn set_controller_page(&mut self, page: Page) {
        if page != self.controller_page {
            self.controller_page = page;
            self.applied = Applied::Pending;
        }
    }

    /// Copies the reference page over the working page.
    pub fn restore_working_page(&mut self) {
        self.working = self.reference;
        self.changed(Page::Working);
    }

    fn changed(&mut self, page: Page) {
        if page == self.controller_page {
            self.applied = Applied::Pending;
        }
    }

    const fn page(&self, page: Page) -> &[i32; CALIBRATION_WORDS] {
        match page {
            Page::Working => &self.working,
            Page::Reference => &self.reference,
        }
    }
}

/// Checks that a word may be written just now.
fn check_place(index: usize, moving: bool) -> Result<WordRange, Refusal> {
    let range = word_range(index).ok_or(Refusal::WriteProtected)?;
    if moving && !range.live {
        return Err(Refusal::AccessDenied);
    }
    Ok(range)
}

/// Checks that a word may be written just now, and with this.
fn check(index: usize, value: i32, moving: bool) -> Result<(), Refusal> {
    let range = check_place(index, moving)?;
    if !(range.min..=range.max).contains(&value) {
        return Err(Refusal::OutOfRange);
    }
    Ok(())
}
