//! The bus on any part: a CAN driver with the traits of `embedded-can`.

use embedded_can::{Error, ErrorKind, Frame as _, nb::Can};
use hitch_protocols::can::Frame;

/// A CAN driver as [`Hardware`](super::Hardware) needs it. Drivers differ in how they tell that the controller has left the
/// bus, which `embedded-can` does not describe; [`Self::driver`] gives access to it.
#[derive(Debug)]
pub struct CanPort<Driver: Can> {
    driver: Driver,
    /// A frame of lower priority that the driver gave back for a more urgent one.
    replaced: Option<Driver::Frame>,
    dropped: u16,
}

impl<Driver: Can> CanPort<Driver> {
    /// A driver that is on the bus at 250 kbit/s.
    #[must_use]
    pub const fn new(driver: Driver) -> Self {
        Self {
            driver,
            replaced: None,
            dropped: 0,
        }
    }

    /// The driver.
    #[must_use]
    pub const fn driver(&self) -> &Driver {
        &self.driver
    }

    /// The next received data frame. An overrun of the driver counts as a dropped frame.
    pub fn receive(&mut self) -> Option<Frame> {
        loop {
            match self.driver.receive() {
                Ok(received) => {
                    let frame = Frame::new(received.id(), received.data());
                    if let Some(frame) = frame.filter(|_| received.is_data_frame()) {
                        return Some(frame);
                    }
                }
                Err(nb::Error::WouldBlock) => return None,
                Err(nb::Error::Other(error)) => {
                    if error.kind() == ErrorKind::Overrun {
                        self.dropped = self.dropped.wrapping_add(1);
                    }
                    return None;
                }
            }
        }
    }

    /// Queues a frame; false if there is no room. A frame that had to give way goes first.
    pub fn send(&mut self, frame: &Frame) -> bool {
        if let Some(waiting) = self.replaced.take() {
            match self.driver.transmit(&waiting) {
                Ok(replaced) => self.replaced = replaced,
                Err(nb::Error::WouldBlock) => self.replaced = Some(waiting),
                // Off the bus the frame would be stale by the time it is sent.
                Err(nb::Error::Other(_)) => {}
            }
        }
        if self.replaced.is_some() {
            return false;
        }
        let frame = Driver::Frame::new(frame.id(), frame.data());
        let queued = frame.and_then(|frame| self.driver.transmit(&frame).ok());
        let is_queued = queued.is_some();
        self.replaced = queued.flatten();
        is_queued
    }

    /// Number of received frames that the driver has lost; it wraps.
    #[must_use]
    pub const fn dropped(&self) -> u16 {
        self.dropped
    }
}
