//! What the application needs of whatever it runs on.

use hitch_protocols::can::Frame;
use hitch_quantities::units::PerMille;

use super::converter::Samples;
use super::drive::Drive;
use super::panel::Panel;

/// What is read at the beginning of a millisecond.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Contacts {
    /// The converters' codes.
    pub samples: Samples,
    /// The operator's contacts.
    pub panel: Panel,
    /// A free-running clock apart from the one that paces the milliseconds, us; it wraps.
    pub clock_us: u32,
    /// Read-back of the line that enables the coils' drivers; none if the board has no read-back.
    pub enable_feedback: Option<bool>,
    /// Main clock by an independent oscillator, per mille of its rate at the start; none if the board doesn't measure it.
    pub clock_ratio: Option<PerMille>,
}

/// The flash that the application has.
#[derive(Clone, Debug)]
pub struct FlashRegions<F> {
    /// Two copies of the calibration.
    pub calibration: F,
    /// Two pages of the log of faults.
    pub fault_log: F,
}

/// Drivers and bus. None of it waits.
pub trait Hardware {
    /// Hands the coils' drivers their values.
    fn drive(&mut self, drive: Drive);

    /// The next frame that was received.
    fn receive(&mut self) -> Option<Frame>;

    /// Takes a frame for the bus; false if there is no room for it now.
    fn send(&mut self, frame: &Frame) -> bool;

    /// Frames that were received and dropped since the start.
    fn frames_dropped(&self) -> u16;
}
