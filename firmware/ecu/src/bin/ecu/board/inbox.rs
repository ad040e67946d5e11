//! Frames that were received and wait for their millisecond.

use heapless::Deque;
use hitch_protocols::can::Frame;

/// Four milliseconds of a bus of 250 kbit/s at its fullest.
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

    /// Takes a frame; if there is no room it is dropped and counted.
    pub fn put(&mut self, frame: Frame) {
        if self.frames.push_back(frame).is_err() {
            self.count_dropped();
        }
    }

    /// Counts a frame, or several in a row, that the controller's own queue had no room for.
    pub fn count_dropped(&mut self) {
        self.dropped = self.dropped.saturating_add(1);
    }

    /// The oldest frame.
    pub fn take(&mut self) -> Option<Frame> {
        self.frames.pop_front()
    }

    /// Frames for which there was no room.
    pub const fn dropped(&self) -> u16 {
        self.dropped
    }
}
