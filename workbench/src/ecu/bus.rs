//! The bus between the ECU and whoever is connected: it carries no more than a real one.

use std::collections::VecDeque;

use hitch_protocols::can::Frame;

use crate::slcan_server::SlcanServer;

/// Frames of eight bytes that 250 kbit/s carry in a millisecond, at most.
const MOST_FRAMES: usize = 2;
/// Frames that may wait to be carried; then the sender has to.
const MOST_WAITING: usize = 1_000;

/// The bus.
#[derive(Debug)]
pub struct Bus {
    server: SlcanServer,
    waiting: VecDeque<Frame>,
}

impl Bus {
    /// The bus served by an SLCAN server.
    pub fn served_by(server: SlcanServer) -> Self {
        Self {
            server,
            waiting: VecDeque::new(),
        }
    }

    /// How many are connected.
    pub fn connected(&self) -> usize {
        self.server.connected()
    }

    /// Frames that the ECU receives in this millisecond.
    pub fn receive(&mut self) -> Vec<Frame> {
        if self.waiting.len() < MOST_WAITING {
            self.waiting.extend(self.server.receive());
        }
        let count = self.waiting.len().min(MOST_FRAMES);
        self.waiting.drain(..count).collect()
    }

    /// Passes on what the ECU has sent.
    pub fn send(&mut self, frames: &[Frame]) {
        frames.iter().for_each(|frame| self.server.send(frame));
    }
}
