//! Where the calibration is kept: the part's last sectors or pages, far from the program.

use embedded_storage::nor_flash::{
    ErrorType, NorFlash, NorFlashError, NorFlashErrorKind, ReadNorFlash,
};
use stm32_metapac::FLASH;

use super::part::flash::{
    BASE, PIECE_BYTES, PIECES, WORD_BYTES, erase_piece, finish, is_usable, program,
    take_damaged_read, unlock,
};

/// The calibration's place in the flash.
pub struct CalibrationFlash(());

/// The flash refused, or was asked for what it can't do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FlashError(NorFlashErrorKind);

impl NorFlashError for FlashError {
    fn kind(&self) -> NorFlashErrorKind {
        self.0
    }
}

impl CalibrationFlash {
    /// The place, which nothing else in the program touches.
    pub fn new() -> Self {
        Self(())
    }
}

impl ErrorType for CalibrationFlash {
    type Error = FlashError;
}

impl ReadNorFlash for CalibrationFlash {
    const READ_SIZE: usize = 1;

    /// Bytes whose error correction fails read as zeros: the record's checksum then marks the copy as damaged.
    fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), FlashError> {
        check(offset, bytes.len(), 1)?;
        let first = BASE + offset as usize;
        for (index, byte) in bytes.iter_mut().enumerate() {
            // SAFETY: inside the place, as checked above; volatile, for the flash changes under the compiler.
            *byte = unsafe { ((first + index) as *const u8).read_volatile() };
        }
        if take_damaged_read() {
            bytes.fill(0);
        }
        Ok(())
    }

    fn capacity(&self) -> usize {
        CAPACITY
    }
}

impl NorFlash for CalibrationFlash {
    const WRITE_SIZE: usize = WORD_BYTES;
    const ERASE_SIZE: usize = PIECE_BYTES;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), FlashError> {
        check(from, to.saturating_sub(from) as usize, PIECE_BYTES)?;
        changed(|| {
            for piece in from as usize / PIECE_BYTES..to as usize / PIECE_BYTES {
                erase_piece(piece as u8);
            }
        })
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), FlashError> {
        check(offset, bytes.len(), WORD_BYTES)?;
        changed(|| {
            let first = BASE + offset as usize;
            for (index, word) in bytes.as_chunks().0.iter().enumerate() {
                // SAFETY: an aligned word inside the place, as checked above.
                unsafe { program(first + index * WORD_BYTES, word) };
            }
        })
    }
}

const CAPACITY: usize = PIECES * PIECE_BYTES;

fn check(offset: u32, length: usize, unit: usize) -> Result<(), FlashError> {
    let offset = offset as usize;
    if !offset.is_multiple_of(unit) || !length.is_multiple_of(unit) {
        return Err(FlashError(NorFlashErrorKind::NotAligned));
    }
    match offset <= CAPACITY && length <= CAPACITY - offset {
        true => Ok(()),
        false => Err(FlashError(NorFlashErrorKind::OutOfBounds)),
    }
}

/// Unlocks the flash, changes it, and locks it again. The data cache is off meanwhile and is reset afterwards: it is not
/// kept up to date (RM0090, 3.5.3; RM0440, 3.3.4), and may be corrupted by reads while the other bank is written.
fn changed(work: impl FnOnce()) -> Result<(), FlashError> {
    if !is_usable() {
        return Err(FlashError(NorFlashErrorKind::Other));
    }
    FLASH.acr().modify(|w| w.set_dcen(false));
    unlock();
    work();
    let good = finish();
    FLASH.acr().modify(|w| w.set_dcrst(true));
    FLASH.acr().modify(|w| w.set_dcrst(false));
    FLASH.acr().modify(|w| w.set_dcen(true));
    match good {
        true => Ok(()),
        false => Err(FlashError(NorFlashErrorKind::Other)),
    }
}
