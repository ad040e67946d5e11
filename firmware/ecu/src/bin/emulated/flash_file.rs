//! Flash in the host's file `flash`: what is in it outlives the emulator, however that ends.

use embedded_storage::nor_flash::{
    ErrorType, NorFlash, NorFlashError, NorFlashErrorKind, ReadNorFlash,
};

use hitch_ecu::FlashRegions;

use crate::host_file::{HostFile, HostFileError};

/// Bytes for the calibration, from the file's begin: as many pages, and as large, as the STM32G474 sets aside.
const CALIBRATION_BYTES: usize = 8_192;
/// Bytes for the log of faults behind it, which a page for the key follows.
const LOG_BYTES: usize = 2 * PAGE_BYTES;
const PAGE_BYTES: usize = 2_048;
const WORD_BYTES: usize = 8;

/// A region of the flash.
#[derive(Clone, Copy)]
pub struct FlashFile {
    file: HostFile,
    start: usize,
    bytes: usize,
}

impl FlashFile {
    /// Opens the file, which has to have the flash's size.
    pub fn open() -> Result<FlashRegions<Self>, HostFileError> {
        let file = HostFile::open_for_both(c"flash")?;
        let region = |start, bytes| Self { file, start, bytes };
        Ok(FlashRegions {
            calibration: region(0, CALIBRATION_BYTES),
            fault_log: region(CALIBRATION_BYTES, LOG_BYTES),
            key: region(CALIBRATION_BYTES + LOG_BYTES, PAGE_BYTES),
        })
    }

    fn read_at(&mut self, offset: usize, target: &mut [u8]) -> Result<(), HostFileError> {
        self.file.seek(self.start + offset)?;
        if self.file.read(target) == target.len() {
            Ok(())
        } else {
            Err(HostFileError::Access)
        }
    }

    fn write_at(&mut self, offset: usize, bytes: &[u8]) -> Result<(), HostFileError> {
        self.file.seek(self.start + offset)?;
        self.file.write_all(bytes)
    }
}

impl NorFlashError for HostFileError {
    fn kind(&self) -> NorFlashErrorKind {
        NorFlashErrorKind::Other
    }
}

impl ErrorType for FlashFile {
    type Error = HostFileError;
}

impl ReadNorFlash for FlashFile {
    const READ_SIZE: usize = 1;

    fn read(&mut self, offset: u32, target: &mut [u8]) -> Result<(), HostFileError> {
        self.read_at(offset as usize, target)
    }

    fn capacity(&self) -> usize {
        self.bytes
    }
}

impl NorFlash for FlashFile {
    const WRITE_SIZE: usize = WORD_BYTES;
    const ERASE_SIZE: usize = PAGE_BYTES;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), HostFileError> {
        for offset in (from as usize..to as usize).step_by(WORD_BYTES) {
            self.write_at(offset, &[u8::MAX; WORD_BYTES])?;
        }
        Ok(())
    }

    /// Word by word, as flash is programmed: a power cut may come between two. Bits only fall.
    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), HostFileError> {
        let places = (offset as usize..).step_by(WORD_BYTES);
        for (place, word) in places.zip(bytes.as_chunks::<WORD_BYTES>().0) {
            let mut stored = [0; WORD_BYTES];
            self.read_at(place, &mut stored)?;
            stored
                .iter_mut()
                .zip(word)
                .for_each(|(old, new)| *old &= new);
            self.write_at(place, &stored)?;
        }
        Ok(())
    }
}
