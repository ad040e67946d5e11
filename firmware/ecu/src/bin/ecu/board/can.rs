//! Queue of received frames.

use heapless::Deque;
use hitch_protocols::can::Frame;

/// Capacity: four milliseconds of a fully loaded bus of 250 kbit/s.
const CAPACITY: usize = 16;

/// The queue.
pub struct Inbox {
    frames: Deque<Frame, CAPACITY>,
    dropped: u16,
}

impl Inbox {
    /// An empty one.
    pub const fn new() -> Self {
        Self {
            frames: Deque::new(),
            dropped: 0,
        }
    }

    /// Adds a frame; if there is no room it is dropped and counted.
    pub fn put(&mut self, frame: Frame) {
        if self.frames.push_back(frame).is_err() {
            self.count_dropped();
        }
    }

    /// Counts a frame, or several consecutive ones, dropped by the controller's hardware queue.
    pub fn count_dropped(&mut self) {
        self.dropped = self.dropped.wrapping_add(1);
    }

    /// The oldest frame.
    pub fn take(&mut self) -> Option<Frame> {
        self.frames.pop_front()
    }

    /// Number of dropped frames; it wraps.
    pub const fn dropped(&self) -> u16 {
        self.dropped
    }
}
