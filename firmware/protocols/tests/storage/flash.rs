//! Flash in RAM: it loses power at any byte, and parts of it can't be read.

use std::cell::{RefCell, RefMut};
use std::ops::Range;
use std::rc::Rc;

use embedded_storage::nor_flash::{
    ErrorType, NorFlash, NorFlashError, NorFlashErrorKind, ReadNorFlash,
};

/// Bytes of a page.
pub const PAGE: usize = 1_024;
/// Pages of the flash.
pub const PAGES: usize = 6;

/// Programming clears bits, erasing sets them, and power may fail after any byte of either.
#[derive(Clone)]
pub struct Flash {
    pub bytes: Vec<u8>,
    /// Bytes that may still be programmed or erased before power fails.
    pub power: usize,
    /// What the byte under way looks like when power fails: these bits are done.
    pub done: u8,
    /// What the rest of the page or chunk under way holds when power fails; repeated. Empty: what it held before.
    pub torn: Vec<u8>,
    /// A read that touches these bytes fails.
    pub unreadable: Range<usize>,
    /// Writing and erasing change nothing, and nobody says so.
    pub protected: bool,
    /// How often it was read.
    pub reads: usize,
}

/// Power failed, or what was asked for can't be read.
#[derive(Debug, PartialEq)]
pub struct FlashError;

impl NorFlashError for FlashError {
    fn kind(&self) -> NorFlashErrorKind {
        NorFlashErrorKind::Other
    }
}

impl Flash {
    /// Erased.
    pub fn blank() -> Self {
        Self {
            bytes: vec![0xFF; PAGE * PAGES],
            power: usize::MAX,
            done: 0,
            torn: Vec::new(),
            unreadable: 0..0,
            protected: false,
            reads: 0,
        }
    }

    /// The same with power, all of it readable.
    pub fn powered(self) -> Self {
        Self {
            bytes: self.bytes,
            ..Self::blank()
        }
    }

    /// Changes a stretch byte by byte, as far as power lasts.
    fn change(&mut self, at: Range<usize>, to: impl Fn(usize, u8) -> u8) -> Result<(), FlashError> {
        if self.protected {
            return Ok(());
        }
        for place in at.clone() {
            let before = self.bytes[place];
            let after = to(place - at.start, before);
            if self.power == 0 {
                self.bytes[place] = (before & !self.done) | (after & self.done);
                for (byte, torn) in self.bytes[place..at.end]
                    .iter_mut()
                    .zip(self.torn.iter().cycle())
                {
                    *byte = *torn;
                }
                return Err(FlashError);
            }
            self.power -= 1;
            self.bytes[place] = after;
        }
        Ok(())
    }
}

impl ErrorType for Flash {
    type Error = FlashError;
}

impl ReadNorFlash for Flash {
    const READ_SIZE: usize = 1;

    fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), FlashError> {
        let (from, to) = (offset as usize, offset as usize + bytes.len());
        self.reads += 1;
        if from < self.unreadable.end && self.unreadable.start < to {
            return Err(FlashError);
        }
        bytes.copy_from_slice(&self.bytes[from..to]);
        Ok(())
    }

    fn capacity(&self) -> usize {
        self.bytes.len()
    }
}

impl NorFlash for Flash {
    const WRITE_SIZE: usize = 8;
    const ERASE_SIZE: usize = PAGE;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), FlashError> {
        let pages = from as usize..to as usize;
        assert!(pages.start.is_multiple_of(PAGE) && pages.end.is_multiple_of(PAGE));
        self.change(pages, |_, _| 0xFF)
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), FlashError> {
        let from = offset as usize;
        assert!(from.is_multiple_of(8) && bytes.len().is_multiple_of(8));
        self.change(from..from + bytes.len(), |index, before| {
            before & bytes[index]
        })
    }
}

/// Flash that a test changes while a store has it.
#[derive(Clone)]
pub struct Shared(Rc<RefCell<Flash>>);

impl Shared {
    /// Shares it.
    pub fn new(flash: Flash) -> Self {
        Self(Rc::new(RefCell::new(flash)))
    }

    /// The flash.
    pub fn flash(&self) -> RefMut<'_, Flash> {
        self.0.borrow_mut()
    }
}

impl ErrorType for Shared {
    type Error = FlashError;
}

impl ReadNorFlash for Shared {
    const READ_SIZE: usize = Flash::READ_SIZE;

    fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), FlashError> {
        self.flash().read(offset, bytes)
    }

    fn capacity(&self) -> usize {
        self.flash().capacity()
    }
}

impl NorFlash for Shared {
    const WRITE_SIZE: usize = Flash::WRITE_SIZE;
    const ERASE_SIZE: usize = Flash::ERASE_SIZE;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), FlashError> {
        self.flash().erase(from, to)
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), FlashError> {
        let mut flash = self.flash();
        let place = offset as usize..offset as usize + bytes.len();
        let blank = flash.bytes[place].iter().all(|&byte| byte == 0xFF);
        assert!(blank || flash.protected, "programmed twice at {offset}");
        flash.write(offset, bytes)
    }
}
