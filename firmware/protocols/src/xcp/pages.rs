//! The two pages of the calibration: working page in RAM, and reference page as stored.
//!
//! A tool writes word by word, so a page may be temporarily inconsistent: a curve that does not rise, a lower limit
//! above the upper one. The controller gets only complete and validated pages; until then it keeps the previous one.

use hitch_quantities::calibration::calibration_words::{CALIBRATION_WORDS, WordRange, word_range};
use hitch_quantities::{Calibration, CalibrationError, ValidCalibration};

use super::error::Refusal;
use super::memory::Page;

/// State of the last change.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum Applied {
    /// In use by the controller.
    #[default]
    InUse = 0,
    /// Not yet passed to the controller.
    Pending = 1,
    /// The page is inconsistent; the controller keeps the previous one.
    Inconsistent = 2,
}

/// What a writer may change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Right {
    /// Values of the live class.
    Moving,
    /// The same, values of the machine class, and safety values as far as that tightens the stored ones.
    AtRest,
    /// All values.
    WithKey,
}

/// Bytes of a word.
const WORD_BYTES: usize = 4;
/// Maximum number of bytes of one write command.
const LONGEST_PIECE: usize = 7;

/// The first part of an incomplete word.
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

    /// Offset of the next missing byte.
    fn end(&self) -> usize {
        self.word
            .saturating_mul(WORD_BYTES)
            .saturating_add(self.length)
    }

    /// The stored part of the word, followed by `bytes`, in `room`.
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
    requires_key_to_store: bool,
}

impl CalibrationPages {
    /// Both pages with the stored calibration.
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
            requires_key_to_store: false,
        }
    }

    /// The stored safety values are lost: only the key allows to store others.
    pub const fn require_key_to_store(&mut self) {
        self.requires_key_to_store = true;
    }

    /// Whether the working page can be stored only with the key.
    #[must_use]
    pub const fn requires_key_to_store(&self) -> bool {
        self.requires_key_to_store
    }

    /// Takes back what only the key allows to write. Called at the end of a session with the key: what it has not stored
    /// does not stay.
    pub fn revert_loosened(&mut self) {
        let mut reverted = false;
        let pairs = self.working.iter_mut().zip(&self.reference);
        for (index, (working, &stored)) in (0..CALIBRATION_WORDS).zip(pairs) {
            if loosens(index, stored, *working) {
                *working = stored;
                reverted = true;
            }
        }
        if reverted {
            self.changed(Page::Working);
        }
    }

    /// The new calibration for the controller, once after each change that results in a consistent page.
    ///
    /// # Errors
    /// The inconsistency, once: the controller keeps the previous calibration.
    pub fn take_change(&mut self) -> Option<Result<ValidCalibration, CalibrationError>> {
        if self.applied != Applied::Pending {
            return None;
        }
        let checked = Calibration::seal_words(self.page(self.controller_page));
        self.applied = match checked {
            Ok(_) => Applied::InUse,
            Err(_) => Applied::Inconsistent,
        };
        Some(checked)
    }

    /// State of the last change.
    #[must_use]
    pub const fn applied(&self) -> Applied {
        self.applied
    }

    /// The working page, for storing.
    ///
    /// # Errors
    /// If it is inconsistent.
    pub fn to_store(&self) -> Result<ValidCalibration, CalibrationError> {
        Calibration::seal_words(&self.working)
    }

    /// `stored` is in flash now and becomes the reference page.
    pub fn stored(&mut self, stored: &ValidCalibration) {
        self.reference = stored.to_words();
        self.requires_key_to_store = false;
        if self.controller_page == Page::Reference {
            self.applied = Applied::Pending;
        }
    }

    /// Replaces the working page, for example after teaching.
    pub fn replace_working(&mut self, calibration: &ValidCalibration) {
        self.working = calibration.to_words();
        self.changed(Page::Working);
    }

    /// A word of the tool's page.
    #[must_use]
    pub fn word(&self, index: usize) -> Option<i32> {
        self.page(self.tool_page).get(index).copied()
    }

    /// Writes bytes of the block from `offset`. Whether a safety value becomes looser is told by the stored one: what a
    /// tool has tightened it may take back until it is stored.
    ///
    /// A word is checked and changed as a unit. Tools split long writes into pieces of six or seven bytes, so a piece
    /// may end inside a word; its first part is kept until the next piece completes it. A piece that begins inside a
    /// word without continuing the last one is refused.
    ///
    /// # Errors
    /// The reason for the refusal; nothing was changed.
    pub fn write(&mut self, offset: usize, bytes: &[u8], right: Right) -> Result<(), Refusal> {
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
            check(index, value, right)?;
            let stored = self.reference.get(index).copied().unwrap_or(value);
            if right != Right::WithKey && loosens(index, stored, value) {
                return Err(Refusal::AccessLocked);
            }
        }
        if !rest.is_empty() {
            let word = first.saturating_add(piece.len() / WORD_BYTES);
            check_place(word, right)?;
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

    /// The page of the tool.
    #[must_use]
    pub const fn tool_page(&self) -> Page {
        self.tool_page
    }

    /// The page of the controller.
    #[must_use]
    pub const fn controller_page(&self) -> Page {
        self.controller_page
    }

    /// Selects the page of the tool.
    pub const fn set_tool_page(&mut self, page: Page) {
        self.tool_page = page;
    }

    /// Selects the page of the controller.
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

/// Whether `value` in place of the stored one requires the key.
fn loosens(index: usize, stored: i32, value: i32) -> bool {
    word_range(index).is_some_and(|range| range.class.requires_key(stored, value))
}

/// Checks that a word may be written now.
fn check_place(index: usize, right: Right) -> Result<WordRange, Refusal> {
    let range = word_range(index).ok_or(Refusal::WriteProtected)?;
    if right == Right::Moving && !range.class.is_live() {
        return Err(Refusal::AccessDenied);
    }
    Ok(range)
}

/// Checks that a word may be written now with this value.
fn check(index: usize, value: i32, right: Right) -> Result<(), Refusal> {
    let range = check_place(index, right)?;
    if !(range.min..=range.max).contains(&value) {
        return Err(Refusal::OutOfRange);
    }
    Ok(())
}
