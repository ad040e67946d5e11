//! The slave's end of the connection: commands in, answers and samples out.

use heapless::{Deque, Vec};

use super::error::Refusal;
use super::memory::Memory;
use crate::can::Frame;
use crate::j1939::{Id, Pgn};

/// Packets that wait for the bus.
const QUEUE: usize = 32;
/// Priority on the bus: the lowest but one, so that tuning never holds up the tractor.
const PRIORITY: u8 = 6;
/// Address of the tool, as diagnostic tools have it (249: off-board service tool).
pub const TOOL_ADDRESS: u8 = 249;

/// What goes in one frame.
type Packet = Vec<u8, 8>;

const POSITIVE: u8 = 0xFF;
const ERROR: u8 = 0xFE;
const CONNECT: u8 = 0xFF;
const DISCONNECT: u8 = 0xFE;
const SET_MTA: u8 = 0xF6;
const UPLOAD: u8 = 0xF5;
const SHORT_UPLOAD: u8 = 0xF4;
const DOWNLOAD: u8 = 0xF0;

/// When measurements are sampled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Event {
    /// With every step of the controller.
    Every1Ms = 0,
    /// With every tenth.
    Every10Ms = 1,
    /// With every hundredth.
    Every100Ms = 2,
}

/// The slave. It talks to one tool at a time, on proprietary J1939 groups: commands to our address from the
/// tool's, answers back.
#[derive(Clone, Debug, Default)]
pub struct Slave {
    address: Option<u8>,
    connected: bool,
    transfer_address: u32,
    queue: Deque<Packet, QUEUE>,
    store_requested: bool,
}

impl Slave {
    /// A slave that nobody is connected to.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            address: None,
            connected: false,
            transfer_address: 0,
            queue: Deque::new(),
            store_requested: false,
        }
    }

    /// Our address on the bus, `None` while there is none: then nothing is said.
    pub const fn set_address(&mut self, address: Option<u8>) {
        self.address = address;
    }

    /// True while a tool is connected.
    #[must_use]
    pub const fn is_connected(&self) -> bool {
        self.connected
    }

    /// Takes a frame from the bus. What isn't a command for us changes nothing.
    pub fn receive(&mut self, frame: &Frame, memory: &mut impl Memory, _now_us: u32) {
        let Some(id) = frame.extended_data_id().map(Id::unpack) else {
            return;
        };
        let for_us = id.pgn == Pgn::PROPRIETARY_A
            && self.address == Some(id.destination)
            && id.source == TOOL_ADDRESS;
        let Some((&command, rest)) = frame.data().split_first().filter(|_| for_us) else {
            return;
        };
        // Until a tool has connected, nothing but CONNECT is answered.
        if !self.connected && command != CONNECT {
            return;
        }
        let answer = match self.obey(command, rest, memory) {
            Ok(answer) => answer,
            Err(refusal) => packet(ERROR, &[refusal as u8]),
        };
        // Tools wait for an answer before the next command, so there is room unless they don't.
        let _ = self.queue.push_back(answer);
    }

    fn obey(
        &mut self,
        command: u8,
        rest: &[u8],
        memory: &mut impl Memory,
    ) -> Result<Packet, Refusal> {
        match (command, rest) {
            (CONNECT, _) => {
                self.connected = true;
                // Calibration and measuring; little-endian, byte granularity; 8 bytes both ways; version 1.
                Ok(packet(POSITIVE, &[0x05, 0x00, 8, 8, 0, 1, 1]))
            }
            (DISCONNECT, _) => {
                self.connected = false;
                Ok(packet(POSITIVE, &[]))
            }
            (SET_MTA, [_, _, 0, a, b, c, d, ..]) => {
                self.transfer_address = u32::from_le_bytes([*a, *b, *c, *d]);
                Ok(packet(POSITIVE, &[]))
            }
            (UPLOAD, [count, ..]) => self.upload(*count, memory),
            (SHORT_UPLOAD, [count, _, 0, a, b, c, d, ..]) => {
                self.transfer_address = u32::from_le_bytes([*a, *b, *c, *d]);
                self.upload(*count, memory)
            }
            (DOWNLOAD, [count, data @ ..]) => {
                let data = data.get(..usize::from(*count)).ok_or(Refusal::Syntax)?;
                memory.write(self.transfer_address, data)?;
                self.transfer_address = self.transfer_address.wrapping_add(u32::from(*count));
                Ok(packet(POSITIVE, &[]))
            }
            _ => Err(Refusal::UnknownCommand),
        }
    }

    fn upload(&mut self, count: u8, memory: &impl Memory) -> Result<Packet, Refusal> {
        let mut bytes = [0; 7];
        let target = bytes
            .get_mut(..usize::from(count))
            .ok_or(Refusal::OutOfRange)?;
        memory.read(self.transfer_address, target)?;
        self.transfer_address = self.transfer_address.wrapping_add(u32::from(count));
        Ok(packet(POSITIVE, target))
    }

    /// Samples what is to be measured with this event. Called once a step for each event that is due.
    pub fn event(&mut self, _event: Event, _memory: &impl Memory, _now_us: u32) {}

    /// The next frame for the bus.
    pub fn poll(&mut self) -> Option<Frame> {
        let id = Id {
            priority: PRIORITY,
            pgn: Pgn::PROPRIETARY_A,
            destination: TOOL_ADDRESS,
            source: self.address?,
        };
        Frame::data_frame(id.pack().into(), &self.queue.pop_front()?)
    }

    /// True once after a tool has asked for the working page to be stored. The application stores it, and says how
    /// it went with [`Self::stored`].
    pub fn take_store_request(&mut self) -> bool {
        core::mem::take(&mut self.store_requested)
    }

    /// The storing that was asked for is over.
    pub fn stored(&mut self, _success: bool) {}
}

/// A packet: its identifier and what belongs to it; what doesn't fit is cut off.
fn packet(identifier: u8, rest: &[u8]) -> Packet {
    core::iter::once(identifier)
        .chain(rest.iter().copied())
        .take(8)
        .collect()
}
