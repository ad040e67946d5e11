//! The bus between the ECU and whoever is connected: it carries no more than a real one.

use std::collections::VecDeque;

use hitch_protocols::can::Frame;

use crate::can_door::CanDoor;

/// Frames of eight bytes that 250 kbit/s carry in a millisecond, at most.
const MOST_FRAMES: usize = 2;
/// Frames that may wait to be carried; then the sender has to.
const MOST_WAITING: usize = 1_000;

/// The bus.
#[derive(Debug)]
pub struct Bus {
    door: CanDoor,
    waiting: VecDeque<Frame>,
}

impl Bus {
    /// The bus behind a door.
    pub fn behind(door: CanDoor) -> Self {
        Self {
            door,
            waiting: VecDeque::new(),
        }
    }

    /// How many are connected.
    pub fn connected(&self) -> usize {
        self.door.connected()
    }

    /// What comes to the ECU in this millisecond.
    pub fn heard(&mut self) -> Vec<Frame> {
        if self.waiting.len() < MOST_WAITING {
            self.waiting.extend(self.door.receive());
        }
        let count = self.waiting.len().min(MOST_FRAMES);
        self.waiting.drain(..count).collect()
    }

    /// Passes on what the ECU said.
    pub fn tell(&mut self, said: &[Frame]) {
        said.iter().for_each(|frame| self.door.send(frame));
    }
}
