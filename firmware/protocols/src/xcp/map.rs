//! Address map of the ECU: slots, no pointers.
//!
//! | from | what | slot |
//! |---|---|---|
//! | [`CALIBRATION_BASE`] | the calibration block, on the page that is chosen | a word each, signed |
//! | [`MEASUREMENT_BASE`] | the measurements | four bytes each; the first ones count |
//! | [`IDENTITY_BASE`] | what a description file has to agree with, and names | text |
//!
//! A word of the calibration is checked and changed as a unit; see [`CalibrationPages::write`].

use hitch_quantities::calibration::{CALIBRATION_BYTES, calibration_words};

use super::error::Refusal;
use super::event::Event;
use super::measurements;
use super::measurements::Measurements;
use super::memory::{MemoryRange, Page, Text};
use super::pages::{CalibrationPages, Right};
use crate::key::Nonce;

/// Bytes of a slot.
pub const SLOT_BYTES: u32 = 4;
/// Address of the calibration.
pub const CALIBRATION_BASE: u32 = 0x1000_0000;
/// Address of the measurements.
pub const MEASUREMENT_BASE: u32 = 0x2000_0000;
/// Address of the identity.
pub const IDENTITY_BASE: u32 = 0x3000_0000;

/// Version of this map, which a description file has to match: a hash of the names, units and places of all entries of
/// calibration and measurements.
pub static IDENTITY: [u8; IDENTITY_BYTES] = identity();
const IDENTITY_BYTES: usize = 14;
/// The identity starts with the name of the description file.
const FILE_NAME_BYTES: u8 = 5;
/// Names of the events, consecutive, after the identity.
static EVENT_NAMES: &[u8] = b"1 ms10 ms100 ms";

const fn identity() -> [u8; IDENTITY_BYTES] {
    let mut text = *b"hitch ########";
    let hash = measurements::hash(calibration_words::hash());
    let mut place = 0;
    while place < 8 {
        text[6 + place] = b"0123456789ABCDEF"[(hash >> (28 - 4 * place) & 0xF) as usize];
        place += 1;
    }
    text
}

/// Write permission.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Access {
    /// None: tuning is not enabled on the machine.
    #[default]
    Locked,
    /// Values that are harmless while the hitch moves.
    Moving,
    /// All values as far as they do not loosen safety values, and the working page may be stored: both coils are off and
    /// locked.
    AtRest,
}

/// Memory of the ECU, for the duration of a command.
#[derive(Debug)]
pub struct EcuMemory<'a> {
    /// The calibration.
    pub pages: &'a mut CalibrationPages,
    /// The measurements.
    pub measurements: &'a Measurements,
    /// Write permission.
    pub access: Access,
    /// What makes the next challenge a new one.
    pub nonce: Nonce,
}

impl EcuMemory<'_> {
    /// Changes of the whole page are permitted only at rest.
    fn at_rest(&self) -> Result<(), Refusal> {
        match self.access {
            Access::Locked => Err(Refusal::AccessLocked),
            Access::Moving => Err(Refusal::AccessDenied),
            Access::AtRest => Ok(()),
        }
    }

    /// The byte at an address.
    fn byte(&self, address: u32) -> Result<u8, Refusal> {
        let slot = |base: u32| {
            let offset = address.wrapping_sub(base);
            usize::try_from(offset / SLOT_BYTES).unwrap_or(usize::MAX)
        };
        let word = if address >= IDENTITY_BASE {
            let offset = address.wrapping_sub(IDENTITY_BASE);
            let index = usize::try_from(offset).unwrap_or(usize::MAX);
            let byte = IDENTITY.iter().chain(EVENT_NAMES).nth(index);
            return byte.copied().ok_or(Refusal::AccessDenied);
        } else if address >= MEASUREMENT_BASE {
            self.measurements.slot(slot(MEASUREMENT_BASE))
        } else if address >= CALIBRATION_BASE {
            self.pages.word(slot(CALIBRATION_BASE))
        } else {
            None
        };
        let [a, b, c, d] = word.ok_or(Refusal::AccessDenied)?.to_le_bytes();
        Ok(match address % SLOT_BYTES {
            0 => a,
            1 => b,
            2 => c,
            _ => d,
        })
    }

    /// Reads `target` completely or fails, if a part of it is not readable.
    pub(super) fn read(&self, address: u32, target: &mut [u8]) -> Result<(), Refusal> {
        for (address, byte) in (address..=u32::MAX).zip(target) {
            *byte = self.byte(address)?;
        }
        Ok(())
    }

    /// Writes `bytes` completely or fails, if a part of it is not writable, or a value is out of range; `unlocked`: safety
    /// values may be loosened.
    pub(super) fn write(
        &mut self,
        address: u32,
        bytes: &[u8],
        unlocked: bool,
    ) -> Result<(), Refusal> {
        let offset = calibration_offset(address).ok_or(Refusal::AccessDenied)?;
        let right = match self.access {
            Access::Locked => return Err(Refusal::AccessLocked),
            Access::Moving => Right::Moving,
            Access::AtRest if unlocked => Right::WithKey,
            Access::AtRest => Right::AtRest,
        };
        self.pages.write(offset, bytes, right)
    }

    /// Whether writing is permitted: tuning is enabled on the machine.
    pub(super) fn may_calibrate(&self) -> bool {
        self.access != Access::Locked
    }

    /// Whether the working page may be stored in flash now.
    pub(super) fn may_store(&self) -> bool {
        self.access == Access::AtRest
    }

    /// Selects the page of the controller, if that is possible now.
    pub(super) fn set_controller_page(&mut self, page: Page) -> Result<(), Refusal> {
        self.at_rest()?;
        self.pages.set_controller_page(page);
        Ok(())
    }

    /// Copies the reference page over the working page, if that is possible now.
    pub(super) fn restore_working_page(&mut self) -> Result<(), Refusal> {
        self.at_rest()?;
        self.pages.restore_working_page();
        Ok(())
    }
}

/// Offset of an address in the calibration, if it is inside.
fn calibration_offset(address: u32) -> Option<usize> {
    let offset = usize::try_from(address.checked_sub(CALIBRATION_BASE)?).ok()?;
    (offset < CALIBRATION_BYTES).then_some(offset)
}

/// Address range of a text.
pub(super) fn text_range(text: Text) -> MemoryRange {
    let (offset, length) = match text {
        Text::Identity => (0, IDENTITY_BYTES as u8),
        Text::DescriptionFile => (0, FILE_NAME_BYTES),
        Text::Event(Event::Every1Ms) => (IDENTITY_BYTES as u8, 4),
        Text::Event(Event::Every10Ms) => (IDENTITY_BYTES as u8 + 4, 5),
        Text::Event(Event::Every100Ms) => (IDENTITY_BYTES as u8 + 9, 6),
    };
    MemoryRange {
        address: IDENTITY_BASE | u32::from(offset),
        length,
    }
}
