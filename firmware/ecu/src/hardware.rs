//! Hardware interface of the application.

use hitch_protocols::can::Frame;
use hitch_quantities::units::PerMille;

use super::drive::Drive;
use super::panel::Panel;
use super::samples::Samples;

/// Inputs at the start of a millisecond.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Contacts {
    /// The converters' codes.
    pub samples: Samples,
    /// The operator's contacts.
    pub panel: Panel,
    /// A free-running clock, independent of the time base of the milliseconds, us; it wraps.
    pub clock_us: u32,
    /// Read-back of the enable line of the coil drivers; `None` if the board has none.
    pub enable_feedback: Option<bool>,
    /// Main clock by an independent oscillator, per mille of its rate at the start; `None` if not measured.
    pub clock_ratio: Option<PerMille>,
}

/// Flash regions of the application.
#[derive(Clone, Debug)]
pub struct FlashRegions<F> {
    /// Two copies of the calibration.
    pub calibration: F,
    /// Two pages of the fault log.
    pub fault_log: F,
    /// The secret of the safety values, which is read only.
    pub key: F,
}

/// Drivers and bus. No call blocks.
pub trait Hardware {
    /// Writes the values of the coil drivers.
    fn drive(&mut self, drive: Drive);

    /// The next received frame.
    fn receive(&mut self) -> Option<Frame>;

    /// Queues a frame for the bus; false if there is no room.
    fn send(&mut self, frame: &Frame) -> bool;

    /// Number of received frames that were dropped since the start; it wraps.
    fn frames_dropped(&self) -> u16;

    /// Whether the CAN controller has left the bus after too many errors (bus-off). The driver brings it back.
    fn is_bus_off(&self) -> bool;
}
