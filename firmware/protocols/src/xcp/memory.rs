//! What a slave reads and writes.

use super::error::Refusal;
use super::slave::Event;

/// Page of the calibration.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum Page {
    /// In RAM; can be written.
    #[default]
    Working = 0,
    /// What is stored in flash; can only be read.
    Reference = 1,
}

impl Page {
    /// The page with a number.
    #[must_use]
    pub const fn from_number(number: u8) -> Option<Self> {
        match number {
            0 => Some(Self::Working),
            1 => Some(Self::Reference),
            _ => None,
        }
    }
}

/// A text that tools ask for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Text {
    /// What the description file has to agree with.
    Identity,
    /// Name of the description file, without its ending.
    DescriptionFile,
    /// Name of an event.
    Event(Event),
}

/// A range of memory.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MemoryRange {
    /// Its first byte.
    pub address: u32,
    /// Number of bytes.
    pub length: u8,
}

/// Addresses, and what is behind them.
pub trait Memory {
    /// Reads; all of `target` or nothing.
    ///
    /// # Errors
    /// If not all of it may be read.
    fn read(&self, address: u32, target: &mut [u8]) -> Result<(), Refusal>;

    /// Writes; all of `bytes` or nothing.
    ///
    /// # Errors
    /// If not all of it may be written, or a value is outside its range.
    fn write(&mut self, address: u32, bytes: &[u8]) -> Result<(), Refusal>;

    /// The segment of the calibration: address and length.
    fn segment(&self) -> (u32, u32);

    /// Where a text can be read.
    fn text(&self, text: Text) -> MemoryRange;

    /// True if writing is permitted at all just now: somebody at the machine has enabled tuning.
    fn may_calibrate(&self) -> bool;

    /// The page that tools see.
    fn tool_page(&self) -> Page;

    /// The page that the controller runs on.
    fn controller_page(&self) -> Page;

    /// Chooses the page that tools see.
    ///
    /// # Errors
    /// If it can't be chosen now.
    fn set_tool_page(&mut self, page: Page) -> Result<(), Refusal>;

    /// Chooses the page that the controller runs on.
    ///
    /// # Errors
    /// If it can't be chosen now.
    fn set_controller_page(&mut self, page: Page) -> Result<(), Refusal>;

    /// Copies the reference page over the working page.
    ///
    /// # Errors
    /// If that can't be done now.
    fn restore_working_page(&mut self) -> Result<(), Refusal>;

    /// True if the working page may be stored in flash just now.
    fn may_store(&self) -> bool;
}
