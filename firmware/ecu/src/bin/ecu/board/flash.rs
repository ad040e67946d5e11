//! Flash of key, fault log and calibration: the last sectors or pages of the part, separate from the program.

use embedded_storage::nor_flash::{
    ErrorType, NorFlash, NorFlashError, NorFlashErrorKind, ReadNorFlash,
};
use hitch_ecu::FlashRegions;
use stm32_metapac::FLASH;

use super::part::flash::{
    BASE, CALIBRATION_PIECES, KEY_PIECES, LOG_PIECES, PIECE_BYTES, WORD_BYTES, erase_piece, finish,
    is_usable, program, take_damaged_read, unlock,
};

/// A region of the flash.
pub struct DataFlash {
    first_piece: u8,
    first_address: usize,
    bytes: usize,
}

/// The flash operation failed, or is invalid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FlashError(NorFlashErrorKind);

impl NorFlashError for FlashError {
    fn kind(&self) -> NorFlashErrorKind {
        self.0
    }
}

/// The regions, which are used for nothing else: the key, which the programmer writes, followed by the fault log and the
/// calibration.
pub fn regions() -> FlashRegions<DataFlash> {
    FlashRegions {
        calibration: const { DataFlash::new(KEY_PIECES + LOG_PIECES, CALIBRATION_PIECES) },
        fault_log: const { DataFlash::new(KEY_PIECES, LOG_PIECES) },
        key: const { DataFlash::new(0, KEY_PIECES) },
    }
}

impl DataFlash {
    const fn new(first_piece: usize, pieces: usize) -> Self {
        Self {
            first_piece: first_piece as u8,
            first_address: BASE + first_piece * PIECE_BYTES,
            bytes: pieces * PIECE_BYTES,
        }
    }

    /// The address of `length` bytes at `offset`, if they are in the region and whole units.
    fn address(&self, offset: u32, length: usize, unit: usize) -> Result<usize, FlashError> {
        let offset = offset as usize;
        if !offset.is_multiple_of(unit) || !length.is_multiple_of(unit) {
            return Err(FlashError(NorFlashErrorKind::NotAligned));
        }
        let room = self.bytes.checked_sub(offset);
        if room.is_some_and(|room| length <= room) {
            Ok(self.first_address.saturating_add(offset))
        } else {
            Err(FlashError(NorFlashErrorKind::OutOfBounds))
        }
    }
}

impl ErrorType for DataFlash {
    type Error = FlashError;
}

impl ReadNorFlash for DataFlash {
    const READ_SIZE: usize = 1;

    /// Bytes with failed error correction read as zeros: the checksum then marks the copy or the entry as damaged.
    fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), FlashError> {
        let first = self.address(offset, bytes.len(), 1)? as *const u8;
        for (index, byte) in bytes.iter_mut().enumerate() {
            // SAFETY: inside the region, as checked above; volatile, for the flash changes under the compiler.
            *byte = unsafe { first.wrapping_add(index).read_volatile() };
        }
        if take_damaged_read() {
            bytes.fill(0);
        }
        Ok(())
    }

    fn capacity(&self) -> usize {
        self.bytes
    }
}

impl NorFlash for DataFlash {
    const WRITE_SIZE: usize = WORD_BYTES;
    const ERASE_SIZE: usize = PIECE_BYTES;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), FlashError> {
        self.address(from, to.saturating_sub(from) as usize, PIECE_BYTES)?;
        changed(|| {
            for piece in from as usize / PIECE_BYTES..to as usize / PIECE_BYTES {
                erase_piece(self.first_piece.saturating_add(piece as u8));
            }
        })
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), FlashError> {
        let mut address = self.address(offset, bytes.len(), WORD_BYTES)?;
        changed(|| {
            for word in bytes.as_chunks().0 {
                // SAFETY: an aligned word inside the region, as checked above.
                unsafe { program(address, word) };
                address = address.saturating_add(WORD_BYTES);
            }
        })
    }
}

/// Unlocks the flash, changes it, and locks it again. The data cache is off meanwhile and is reset afterwards: it is
/// not updated (RM0090, 3.5.3; RM0440, 3.3.4), and may be corrupted by reads while the other bank is written.
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
    if good {
        Ok(())
    } else {
        Err(FlashError(NorFlashErrorKind::Other))
    }
}
