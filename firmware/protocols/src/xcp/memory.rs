//! Memory access of a slave.

use super::error::Refusal;
use super::event::Event;
use crate::key::Nonce;

/// Page of the calibration.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum Page {
    /// In RAM; can be written.
    #[default]
    Working = 0,
    /// As stored in flash; read-only.
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

/// A text that tools request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Text {
    /// Identity that the description file has to match.
    Identity,
    /// Name of the description file, without extension.
    DescriptionFile,
    /// Name of an event.
    Event(Event),
}

/// A range of memory.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MemoryRange {
    /// First byte.
    pub address: u32,
    /// Number of bytes.
    pub length: u8,
}

/// Memory map.
pub trait Memory {
    /// Reads `target` completely or fails.
    ///
    /// # Errors
    /// If a part of it is not readable.
    fn read(&self, address: u32, target: &mut [u8]) -> Result<(), Refusal>;

    /// Writes `bytes` completely or fails; `unlocked`: safety values may be loosened.
    ///
    /// # Errors
    /// If a part of it is not writable, or a value is out of range.
    fn write(&mut self, address: u32, bytes: &[u8], unlocked: bool) -> Result<(), Refusal>;

    /// The segment of the calibration: address and length.
    fn segment(&self) -> (u32, u32);

    /// Address range of a text.
    fn text(&self, text: Text) -> MemoryRange;

    /// Whether writing is permitted: tuning is enabled on the machine.
    fn may_calibrate(&self) -> bool;

    /// The page of the tool.
    fn tool_page(&self) -> Page;

    /// The page of the controller.
    fn controller_page(&self) -> Page;

    /// Selects the page of the tool.
    ///
    /// # Errors
    /// If it cannot be selected now.
    fn set_tool_page(&mut self, page: Page) -> Result<(), Refusal>;

    /// Selects the page of the controller.
    ///
    /// # Errors
    /// If it cannot be selected now.
    fn set_controller_page(&mut self, page: Page) -> Result<(), Refusal>;

    /// Copies the reference page over the working page.
    ///
    /// # Errors
    /// If it is not possible now.
    fn restore_working_page(&mut self) -> Result<(), Refusal>;

    /// Whether the working page may be stored in flash now.
    fn may_store(&self) -> bool;

    /// Whether storing requires the key: the stored safety values are lost.
    fn requires_key_to_store(&self) -> bool;

    /// What makes the next challenge a new one.
    fn nonce(&self) -> Nonce;
}
