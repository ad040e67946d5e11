//! The bus at 250 kbit/s on PA11 and PA12, with a queue of received frames. The controller depends on the part.

use heapless::Deque;
use hitch_protocols::can::Frame;
use stm32_metapac::GPIOA;

use super::part::can as part;
use super::pins;

/// Capacity: four milliseconds of a fully loaded bus of 250 kbit/s.
const CAPACITY: usize = 16;

/// The bus.
pub struct Can {
    received: Deque<Frame, CAPACITY>,
    dropped: u16,
}

impl Can {
    /// Joins the bus; it is synchronised after eleven recessive bits, which is not waited for.
    pub fn start() -> Self {
        pins::alternate(GPIOA, 11, part::FUNCTION);
        pins::alternate(GPIOA, 12, part::FUNCTION);
        part::join();
        Self {
            received: Deque::new(),
            dropped: 0,
        }
    }

    /// Empties the hardware queue, which holds three frames. A frame for which there is no room is dropped and counted;
    /// several consecutive ones that the hardware queue has dropped count as one.
    pub fn listen(&mut self) {
        while let Some(frame) = part::received() {
            if self.received.push_back(frame).is_err() {
                self.count_dropped();
            }
        }
        if part::take_overrun() {
            self.count_dropped();
        }
    }

    /// The oldest received frame.
    pub fn next_heard(&mut self) -> Option<Frame> {
        self.received.pop_front()
    }

    /// Whether it has left the bus after too many errors.
    pub fn is_off(&self) -> bool {
        part::is_off()
    }

    /// Number of received frames that were dropped; it wraps.
    pub const fn dropped(&self) -> u16 {
        self.dropped
    }

    /// Queues a frame; false if there is no room.
    pub fn send(&mut self, frame: &Frame) -> bool {
        part::send(frame)
    }

    fn count_dropped(&mut self) {
        self.dropped = self.dropped.wrapping_add(1);
    }
}
