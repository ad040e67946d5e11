//! XCP slave: commands in, answers and samples out.

use heapless::Deque;

use super::checksum::Checksum;
use super::command::{code, event, identifier};
use super::daq::Daq;
use super::error::Refusal;
use super::event::Event;
use super::map::{EcuMemory, text_range};
use super::memory::{MemoryRange, Text};
use super::packet::{Answer, MOST_BYTES, Packet, arguments, done, packet, response};
use super::unlocking::{CALIBRATION, Unlocking};
use super::{checksum, measuring, paging};
use crate::can::Frame;
use crate::j1939::{Id, Pgn};
use crate::key::Secret;

/// Capacity of the queue of answers and events.
const QUEUE: usize = 4;
/// Priority on the bus: the second lowest, so that tuning does not delay other messages.
const PRIORITY: u8 = 6;
/// Address of the tool (249: off-board service tool).
pub const TOOL_ADDRESS: u8 = 249;

/// The other resource, measuring.
const MEASURING: u8 = 0x04;
/// Communication mode: little-endian, bytes; details by GET_COMM_MODE_INFO.
const MORE_INFORMATION: u8 = 0x80;
/// Versions of the layers (major number), and of this slave, 1.0.
const PROTOCOL_VERSION: u8 = 1;
const TRANSPORT_VERSION: u8 = 1;
const DRIVER_VERSION: u8 = 0x10;
/// States of a session.
const STORE_REQUESTED: u8 = 0x01;
const DAQ_RUNNING: u8 = 0x40;

/// The slave. It serves one tool at a time, on proprietary J1939 groups: commands from the tool's address, and answers
/// to it.
#[derive(Clone, Debug, Default)]
pub struct Slave {
    address: Option<u8>,
    connected: bool,
    /// Memory transfer address: start of the next upload or download.
    transfer_address: u32,
    daq: Daq,
    checksum: Option<Checksum>,
    queue: Deque<Packet, QUEUE>,
    store: Store,
    unlocking: Unlocking,
}

/// State of storing the working page.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Store {
    #[default]
    Idle,
    /// The application has not started yet.
    Requested,
    UnderWay,
}

impl Slave {
    /// A slave without connection, with the secret of the safety values. Without one they are locked for good.
    #[must_use]
    pub fn new(secret: Option<Secret>) -> Self {
        Self {
            unlocking: Unlocking::new(secret),
            ..Self::default()
        }
    }

    /// Whether the session may loosen safety values.
    #[must_use]
    pub const fn is_unlocked(&self) -> bool {
        self.unlocking.is_open()
    }

    /// Sets the own address on the bus; with `None` nothing is sent. A connection ends when the address changes.
    pub fn set_address(&mut self, address: Option<u8>) {
        if address != self.address {
            self.disconnect();
            self.address = address;
        }
    }

    /// Whether a tool is connected.
    #[must_use]
    pub const fn is_connected(&self) -> bool {
        self.connected
    }

    /// Processes a frame from the bus; other frames than commands to this node are ignored.
    pub fn receive(&mut self, frame: &Frame, memory: &mut EcuMemory<'_>, now_us: u32) {
        let Some(id) = frame.extended_data_id().map(Id::unpack) else {
            return;
        };
        let for_us = id.pgn == Pgn::PROPRIETARY_A
            && self.address == Some(id.destination)
            && id.source == TOOL_ADDRESS;
        let Some((&command, rest)) = frame.data().split_first().filter(|_| for_us) else {
            return;
        };
        // Without a connection only CONNECT is answered.
        if !self.connected && command != code::CONNECT {
            return;
        }
        match self.dispatch(command, rest, memory, now_us) {
            Ok(Some(answer)) => self.send(answer),
            Ok(None) => {}
            Err(refusal) => self.send(packet(identifier::ERROR, &[refusal as u8])),
        }
    }

    /// Samples the measurements of this event. Called once in a step for each due event, including the 1 ms event,
    /// which also continues long operations.
    pub fn event(&mut self, event: Event, memory: &EcuMemory<'_>, now_us: u32) {
        if event == Event::Every1Ms {
            self.carry_on(memory);
        }
        self.daq.sample(event, memory, now_us);
        if self.daq.take_overload() {
            self.send(packet(identifier::EVENT, &[event::OVERLOAD]));
        }
    }

    /// The next frame: answers first, then samples. Called while there is room for one.
    pub fn poll(&mut self) -> Option<Frame> {
        let id = Id::broadcast(Pgn::PROPRIETARY_A, PRIORITY, self.address?).to(TOOL_ADDRESS);
        let packet = self.queue.pop_front();
        let packet = packet.or_else(|| self.daq.next_packet())?;
        Frame::data_frame(id.pack().into(), &packet)
    }

    /// True once after a request to store the working page. The application stores it, and reports the result with
    /// [`Self::stored`].
    pub fn take_store_request(&mut self) -> bool {
        let requested = self.store == Store::Requested;
        if requested {
            self.store = Store::UnderWay;
        }
        requested
    }

    /// The requested store has ended.
    pub fn stored(&mut self, success: bool) {
        if self.store == Store::Idle {
            return;
        }
        self.store = Store::Idle;
        let event = if success {
            event::STORED
        } else {
            event::NOT_STORED
        };
        if self.connected {
            self.send(packet(identifier::EVENT, &[event]));
        }
    }

    /// A tool waits for each answer before the next command, so the queue overflows only if it does not.
    fn send(&mut self, packet: Packet) {
        let _ = self.queue.push_back(packet);
    }

    fn carry_on(&mut self, memory: &EcuMemory<'_>) {
        self.unlocking.step(memory);
        let answer = self
            .checksum
            .as_mut()
            .and_then(|checksum| checksum.advance(memory));
        if let Some(answer) = answer {
            self.checksum = None;
            self.send(answer);
        }
    }

    fn dispatch(
        &mut self,
        command: u8,
        rest: &[u8],
        memory: &mut EcuMemory<'_>,
        now_us: u32,
    ) -> Answer {
        match command {
            code::CONNECT => Ok(Some(self.connect())),
            code::DISCONNECT => {
                self.disconnect();
                done()
            }
            code::GET_STATUS => self.status(memory),
            code::SYNCH => Err(Refusal::Synchronised),
            code::GET_COMM_MODE_INFO => response(&[0, 0, 0, 0, 0, 0, DRIVER_VERSION]),
            code::GET_ID => self.identity(rest),
            code::SET_REQUEST => self.request_store(rest, memory),
            code::GET_SEED => self.unlocking.seed(rest, memory, now_us),
            code::UNLOCK => self.unlock(rest),
            code::SET_MTA => self.set_transfer_address(rest),
            code::UPLOAD => self.upload(rest, memory),
            code::SHORT_UPLOAD => self.short_upload(rest, memory),
            code::BUILD_CHECKSUM => self.build_checksum(rest),
            code::DOWNLOAD | code::DOWNLOAD_MAX => self.download(command, rest, memory),
            code::SET_CAL_PAGE => paging::set_page(rest, memory),
            code::GET_CAL_PAGE => paging::page(rest, memory),
            code::GET_PAG_PROCESSOR_INFO => paging::info(),
            code::GET_SEGMENT_INFO => paging::segment_info(rest),
            code::GET_PAGE_INFO => paging::page_info(rest),
            code::COPY_CAL_PAGE => paging::copy(rest, memory),
            code::GET_DAQ_EVENT_INFO => {
                let (name, answer) = measuring::event_info(rest)?;
                self.transfer_address = name.address;
                Ok(Some(answer))
            }
            _ => measuring::dispatch(&mut self.daq, command, rest, memory, now_us),
        }
    }

    /// A new connection resets the state, even if the last one was not ended.
    fn connect(&mut self) -> Packet {
        self.disconnect();
        self.connected = true;
        packet(
            identifier::RESPONSE,
            &[
                CALIBRATION | MEASURING,
                MORE_INFORMATION,
                MOST_BYTES as u8,
                MOST_BYTES as u8,
                0,
                PROTOCOL_VERSION,
                TRANSPORT_VERSION,
            ],
        )
    }

    fn disconnect(&mut self) {
        self.connected = false;
        self.unlocking.close();
        self.checksum = None;
        self.daq.free();
        self.queue.clear();
    }

    fn status(&self, memory: &EcuMemory<'_>) -> Answer {
        let mut session = 0;
        if self.store != Store::Idle {
            session |= STORE_REQUESTED;
        }
        if self.daq.is_running() {
            session |= DAQ_RUNNING;
        }
        let protected = if memory.may_calibrate() {
            0
        } else {
            CALIBRATION
        };
        response(&[session, protected, 0, 0, 0])
    }

    /// A wrong key ends the session.
    fn unlock(&mut self, rest: &[u8]) -> Answer {
        let answer = self.unlocking.unlock(rest);
        if answer == Err(Refusal::AccessLocked) {
            self.disconnect();
        }
        answer
    }

    /// Sets the transfer address to a text.
    fn identity(&mut self, rest: &[u8]) -> Answer {
        let [kind] = arguments(rest)?;
        let text = match kind {
            0 => text_range(Text::Identity),
            1 => text_range(Text::DescriptionFile),
            _ => MemoryRange::default(),
        };
        self.transfer_address = text.address;
        response(&[0, 0, 0, text.length, 0, 0, 0])
    }

    fn request_store(&mut self, rest: &[u8], memory: &EcuMemory<'_>) -> Answer {
        const STORE_CALIBRATION: u8 = 0x01;
        match rest {
            [STORE_CALIBRATION, ..] if !memory.may_calibrate() => Err(Refusal::AccessLocked),
            [STORE_CALIBRATION, ..]
                if memory.pages.requires_key_to_store() && !self.is_unlocked() =>
            {
                Err(Refusal::AccessLocked)
            }
            [STORE_CALIBRATION, ..] if !memory.may_store() => Err(Refusal::AccessDenied),
            [STORE_CALIBRATION, ..] => {
                if self.store == Store::Idle {
                    self.store = Store::Requested;
                }
                done()
            }
            [_, ..] => Err(Refusal::OutOfRange),
            [] => Err(Refusal::Syntax),
        }
    }

    fn set_transfer_address(&mut self, rest: &[u8]) -> Answer {
        let [_, _, extension, a, b, c, d] = arguments(rest)?;
        self.transfer_address = address(extension, [a, b, c, d])?;
        done()
    }

    fn short_upload(&mut self, rest: &[u8], memory: &EcuMemory<'_>) -> Answer {
        let [_, _, extension, a, b, c, d] = arguments(rest)?;
        self.transfer_address = address(extension, [a, b, c, d])?;
        self.upload(rest, memory)
    }

    fn upload(&mut self, rest: &[u8], memory: &EcuMemory<'_>) -> Answer {
        let [count] = arguments(rest)?;
        let mut bytes = [0; MOST_BYTES - 1];
        let target = bytes.get_mut(..usize::from(count));
        let target = target.ok_or(Refusal::OutOfRange)?;
        memory.read(self.transfer_address, target)?;
        self.transfer_address = self.transfer_address.wrapping_add(count.into());
        response(target)
    }

    fn build_checksum(&mut self, rest: &[u8]) -> Answer {
        let [_, _, _, a, b, c, d] = arguments(rest)?;
        let length = u32::from_le_bytes([a, b, c, d]);
        if length > checksum::LONGEST {
            return Ok(Some(checksum::too_long()));
        }
        self.checksum = Some(Checksum::new(self.transfer_address, length));
        self.transfer_address = self.transfer_address.wrapping_add(length);
        // The answer is sent at the end of the operation.
        Ok(None)
    }

    fn download(&mut self, command: u8, rest: &[u8], memory: &mut EcuMemory<'_>) -> Answer {
        let data = if command == code::DOWNLOAD_MAX {
            rest.get(..MOST_BYTES - 1)
        } else {
            rest.split_first()
                .and_then(|(&count, data)| data.get(..usize::from(count)))
        };
        let data = data.ok_or(Refusal::Syntax)?;
        memory.write(self.transfer_address, data, self.is_unlocked())?;
        let written = u32::try_from(data.len()).unwrap_or(0);
        self.transfer_address = self.transfer_address.wrapping_add(written);
        done()
    }
}

/// There is only one address space.
const fn address(extension: u8, bytes: [u8; 4]) -> Result<u32, Refusal> {
    if extension == 0 {
        Ok(u32::from_le_bytes(bytes))
    } else {
        Err(Refusal::AccessDenied)
    }
}
