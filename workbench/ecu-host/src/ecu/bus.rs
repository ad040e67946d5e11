//! CAN bus between the ECU and connected tools, with the bandwidth of a real bus.

use std::collections::VecDeque;

use hitch_protocols::can::Frame;

use crate::ecu::slcan_server::SlcanServer;

/// Maximum number of eight-byte frames in a millisecond at 250 kbit/s.
const MOST_FRAMES: usize = 2;
/// Capacity of the transmit queue, frames; a sender has to wait when it is full.
const MOST_WAITING: usize = 1_000;

/// The bus.
#[derive(Debug)]
pub struct Bus {
    server: SlcanServer,
    waiting: VecDeque<Frame>,
}

impl Bus {
    /// A bus behind an SLCAN server.
    pub fn served_by(server: SlcanServer) -> Self {
        Self {
            server,
            waiting: VecDeque::new(),
        }
    }

    /// Number of connections.
    pub fn connected(&self) -> usize {
        self.server.connected()
    }

    /// Frames for the ECU in this millisecond.
    pub fn receive(&mut self) -> Vec<Frame> {
        if self.waiting.len() < MOST_WAITING {
            self.waiting.extend(self.server.receive());
        }
        let count = self.waiting.len().min(MOST_FRAMES);
        self.waiting.drain(..count).collect()
    }

    /// Sends the ECU's frames.
    pub fn send(&mut self, frames: &[Frame]) {
        frames.iter().for_each(|frame| self.server.send(frame));
    }
}
