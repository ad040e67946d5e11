//! Flash of the ECU on the host, and its initial contents.

use std::cell::RefCell;
use std::ops::Range;
use std::rc::Rc;

use embedded_storage::nor_flash::{
    ErrorType, NorFlash, NorFlashError, NorFlashErrorKind, ReadNorFlash,
};
use hitch_ecu::FlashRegions;
use hitch_protocols::key::Secret;
use hitch_protocols::storage::CalibrationStore;
use hitch_quantities::ValidCalibration;

/// Size of the emulated ECU's flash: two copies of the calibration, two pages of the fault log, and one of the key.
pub const FLASH_BYTES: usize = KEY_START + PAGE_BYTES;
const KEY_START: usize = CALIBRATION_BYTES + 2 * PAGE_BYTES;
/// Size of the two copies of the calibration, which are at its start.
pub const CALIBRATION_BYTES: usize = 8_192;
const PAGE_BYTES: usize = 2_048;
const WORD_BYTES: usize = 8;

/// Flash in memory, with a simulated power cut at any word. Clones share their contents. Access is to the calibration's
/// region, unless another of [`Self::regions`] is selected.
#[derive(Debug, Clone)]
pub struct CutFlash {
    cells: Rc<RefCell<Cells>>,
    region: Range<usize>,
}

#[derive(Debug)]
struct Cells {
    bytes: Vec<u8>,
    /// Remaining words until the power cut; `None` without one.
    words_left: Option<u64>,
}

/// Power is off, or the access is invalid.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CutFlashError;

impl NorFlashError for CutFlashError {
    fn kind(&self) -> NorFlashErrorKind {
        NorFlashErrorKind::Other
    }
}

impl CutFlash {
    /// Flash with these contents.
    pub fn holding(bytes: Vec<u8>) -> Self {
        Self {
            cells: Rc::new(RefCell::new(Cells {
                bytes,
                words_left: None,
            })),
            region: 0..CALIBRATION_BYTES,
        }
    }

    /// Erased flash.
    pub fn blank() -> Self {
        Self::holding(vec![u8::MAX; FLASH_BYTES])
    }

    /// The regions of an ECU.
    pub fn regions(&self) -> FlashRegions<Self> {
        let region = |region: Range<usize>| Self {
            cells: Rc::clone(&self.cells),
            region,
        };
        FlashRegions {
            calibration: region(0..CALIBRATION_BYTES),
            fault_log: region(CALIBRATION_BYTES..KEY_START),
            key: region(KEY_START..FLASH_BYTES),
        }
    }

    /// Writes the secret of the safety values, as at the end of the line.
    pub fn set_key(&self, key: &Secret) {
        let record = key.to_record();
        let mut cells = self.cells.borrow_mut();
        let place = KEY_START..KEY_START + record.len();
        if let Some(place) = cells.bytes.get_mut(place) {
            place.copy_from_slice(&record);
        }
    }

    /// The whole contents.
    pub fn bytes(&self) -> Vec<u8> {
        self.cells.borrow().bytes.clone()
    }

    /// Cuts the power after this many words; `None` disables the cut.
    pub fn cut_after(&self, words: Option<u64>) {
        self.cells.borrow_mut().words_left = words;
    }

    /// Whether the power is off.
    pub fn is_cut(&self) -> bool {
        self.cells.borrow().words_left == Some(0)
    }

    fn each_word(
        &self,
        from: usize,
        to: usize,
        mut change: impl FnMut(usize, &mut [u8]),
    ) -> Result<(), CutFlashError> {
        let mut cells = self.cells.borrow_mut();
        for place in (from..to).step_by(WORD_BYTES) {
            match &mut cells.words_left {
                Some(0) => return Err(CutFlashError),
                Some(left) => *left -= 1,
                None => {}
            }
            let region = cells.bytes.get_mut(self.region.clone());
            let word = region.and_then(|bytes| bytes.get_mut(place..place + WORD_BYTES));
            change(place, word.ok_or(CutFlashError)?);
        }
        Ok(())
    }
}

impl ErrorType for CutFlash {
    type Error = CutFlashError;
}

impl ReadNorFlash for CutFlash {
    const READ_SIZE: usize = 1;

    fn read(&mut self, offset: u32, target: &mut [u8]) -> Result<(), CutFlashError> {
        let cells = self.cells.borrow();
        let region = cells.bytes.get(self.region.clone());
        let source =
            region.and_then(|bytes| bytes.get(offset as usize..offset as usize + target.len()));
        target.copy_from_slice(source.ok_or(CutFlashError)?);
        Ok(())
    }

    fn capacity(&self) -> usize {
        self.region.len()
    }
}

impl NorFlash for CutFlash {
    const WRITE_SIZE: usize = WORD_BYTES;
    const ERASE_SIZE: usize = PAGE_BYTES;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), CutFlashError> {
        self.each_word(from as usize, to as usize, |_, word| word.fill(u8::MAX))
    }

    /// Programming clears bits only.
    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), CutFlashError> {
        let first = offset as usize;
        self.each_word(first, first + bytes.len(), |place, word| {
            let new = &bytes[place - first..];
            word.iter_mut().zip(new).for_each(|(old, new)| *old &= new);
        })
    }
}

/// The flash of an ECU as delivered with `calibration`.
pub fn delivered(calibration: &ValidCalibration) -> Vec<u8> {
    let flash = CutFlash::blank();
    let mut store = CalibrationStore::new(flash.clone());
    store
        .store(calibration)
        .expect("flash without faults takes a calibration");
    flash.bytes()
}
