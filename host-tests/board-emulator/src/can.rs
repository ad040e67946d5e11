//! The bus, and the controllers of both parts on it.

use std::collections::VecDeque;

use embedded_can::{ExtendedId, Id, StandardId};
use hitch_protocols::can::Frame;

use super::part::{CAN, FDCAN_RAM, Part};
use super::registers::Registers;

/// A bit at 250 kbit/s, ns.
const BIT_NS: f64 = 4e3;
/// Frames that a controller's receive queue holds.
const QUEUE: usize = 3;
/// 128 times eleven recessive bits end a bus-off.
const RECOVERY_NS: f64 = 128.0 * 11.0 * BIT_NS;

/// Time that a frame takes on the bus, without stuff bits, ns.
#[must_use]
pub fn frame_ns(frame: &Frame) -> f64 {
    let overhead = match frame.id() {
        Id::Standard(_) => 47,
        Id::Extended(_) => 67,
    };
    f64::from(overhead + 8 * u32::from(frame.length())) * BIT_NS
}

/// A frame that the image has handed over.
#[derive(Clone, Debug)]
struct Pending {
    frame: Frame,
    slot: u32,
}

/// Controller and bus.
#[derive(Clone, Debug)]
pub struct Can {
    part: Part,
    /// Frames that other nodes send.
    pub from_others: VecDeque<Frame>,
    /// Frames that the image has sent.
    pub sent: Vec<Frame>,
    received: VecDeque<Frame>,
    pending: VecDeque<Pending>,
    /// The frame on the bus ends then, ns.
    on_bus: Option<(f64, Option<Pending>)>,
    /// The controller lost a frame as its queue was full.
    overrun: bool,
    /// Frames lost that way.
    pub lost: u32,
    /// It is off the bus until then, ns.
    off_until_ns: f64,
    off: bool,
    /// Index of the next free place in the receive queue (FDCAN).
    get_index: u32,
    put_index: u32,
    /// No other node acknowledges.
    pub alone: bool,
}

impl Can {
    /// After a reset.
    #[must_use]
    pub const fn new(part: Part) -> Self {
        Self {
            part,
            from_others: VecDeque::new(),
            sent: Vec::new(),
            received: VecDeque::new(),
            pending: VecDeque::new(),
            on_bus: None,
            overrun: false,
            lost: 0,
            off_until_ns: 0.0,
            off: false,
            get_index: 0,
            put_index: 0,
            alone: false,
        }
    }

    /// Whether the controller takes part.
    fn is_on(&self, registers: &Registers) -> bool {
        let initialising = match self.part {
            Part::Stm32f405 => registers.bit(CAN, 0) || registers.bit(CAN, 1),
            Part::Stm32g474 => registers.bit(CAN + 0x18, 0),
        };
        !initialising && !self.off
    }

    /// Too many errors: the controller leaves the bus.
    pub fn go_off(&mut self, registers: &mut Registers, now_ns: f64) {
        self.off = true;
        self.off_until_ns = f64::INFINITY;
        if self.part == Part::Stm32f405 && registers.bit(CAN, 6) {
            self.off_until_ns = now_ns + RECOVERY_NS;
        }
        if self.part == Part::Stm32g474 {
            registers.modify(CAN + 0x18, 0, 1);
        }
        self.on_bus = None;
    }

    /// The controller loses a frame, as it does when its queue is full.
    pub const fn lose(&mut self) {
        self.overrun = true;
        self.lost += 1;
    }

    /// True while it is off the bus.
    #[must_use]
    pub const fn is_off(&self) -> bool {
        self.off
    }

    /// When something happens on the bus, ns.
    #[must_use]
    pub fn next_ns(&self) -> f64 {
        let frame = self.on_bus.as_ref().map_or(f64::INFINITY, |(end, _)| *end);
        if self.off {
            frame.min(self.off_until_ns)
        } else {
            frame
        }
    }

    /// Lets time pass on the bus.
    pub fn advance(&mut self, registers: &Registers, now_ns: f64) {
        if self.off && now_ns >= self.off_until_ns {
            self.off = false;
        }
        if let Some((end_ns, _)) = self.on_bus {
            if now_ns < end_ns {
                return;
            }
            if let Some((_, mine)) = self.on_bus.take() {
                self.end_frame(mine, registers);
            }
        }
        // Others first: the image's frames wait for a free bus, and the order of priority does not matter here.
        let start = now_ns;
        if let Some(frame) = self.from_others.front() {
            self.on_bus = Some((start + frame_ns(frame), None));
        } else if self.is_on(registers)
            && !self.alone
            && let Some(mine) = self.pending.pop_front()
        {
            self.on_bus = Some((start + frame_ns(&mine.frame), Some(mine)));
        }
    }

    fn end_frame(&mut self, mine: Option<Pending>, registers: &Registers) {
        if let Some(mine) = mine {
            self.sent.push(mine.frame);
            return;
        }
        let Some(frame) = self.from_others.pop_front() else {
            return;
        };
        if !self.is_on(registers) {
            return;
        }
        if self.received.len() >= QUEUE {
            self.lose();
            return;
        }
        self.received.push_back(frame);
        self.put_index = (self.put_index + 1) % QUEUE as u32;
    }

    fn occupied(&self, slot: u32) -> bool {
        let sending = self.on_bus.as_ref().and_then(|(_, mine)| mine.as_ref());
        self.pending
            .iter()
            .chain(sending)
            .any(|pending| pending.slot == slot)
    }

    fn occupied_slots(&self) -> u32 {
        (0..QUEUE as u32)
            .filter(|&slot| self.occupied(slot))
            .count() as u32
    }

    fn free_slot(&self) -> Option<u32> {
        (0..QUEUE as u32).find(|&slot| !self.occupied(slot))
    }

    /// A read of a register at `offset`.
    #[must_use]
    pub fn read(&self, offset: u32, registers: &Registers) -> u32 {
        let stored = registers.get(CAN + offset);
        match self.part {
            Part::Stm32f405 => self.read_bxcan(offset, stored),
            Part::Stm32g474 => self.read_fdcan(offset, stored),
        }
    }

    fn read_bxcan(&self, offset: u32, stored: u32) -> u32 {
        let flag = |set: bool, bit: u32| u32::from(set) << bit;
        match offset {
            0x04 => stored,
            0x08 => {
                let free =
                    (0..3).fold(0, |bits, slot| bits | flag(!self.occupied(slot), 26 + slot));
                free | self.free_slot().unwrap_or(3) << 24
            }
            0x0C => {
                let waiting = self.received.len() as u32;
                waiting | flag(self.received.len() == QUEUE, 3) | flag(self.overrun, 4)
            }
            0x18 => flag(self.off, 2),
            0x1B0..=0x1BC => self.received.front().map_or(0, |frame| {
                let [identifier, length, low, high] = bxcan_words(frame);
                [identifier, length, low, high][(offset as usize - 0x1B0) / 4]
            }),
            _ => stored,
        }
    }

    fn read_fdcan(&self, offset: u32, stored: u32) -> u32 {
        let flag = |set: bool, bit: u32| u32::from(set) << bit;
        match offset {
            0x44 => flag(self.off, 7),
            0x90 => {
                self.received.len() as u32
                    | self.get_index << 8
                    | self.put_index << 16
                    | flag(self.received.len() == QUEUE, 24)
                    | flag(self.overrun, 25)
            }
            0xC4 => {
                let used = self.occupied_slots();
                (QUEUE as u32 - used)
                    | self.free_slot().unwrap_or(0) << 16
                    | flag(self.free_slot().is_none(), 21)
            }
            _ => stored,
        }
    }

    /// After a write of a register at `offset`.
    pub fn written(&mut self, offset: u32, value: u32, registers: &mut Registers, now_ns: f64) {
        match self.part {
            Part::Stm32f405 => self.written_bxcan(offset, value, registers),
            Part::Stm32g474 => self.written_fdcan(offset, value, registers, now_ns),
        }
        if self.on_bus.is_none() {
            self.advance(registers, now_ns);
        }
    }

    fn written_bxcan(&mut self, offset: u32, value: u32, registers: &mut Registers) {
        match offset {
            // Initialisation and sleep are acknowledged at once.
            0x00 => registers.set(CAN + 4, value & 0b11),
            0x0C => {
                if value >> 5 & 1 == 1 {
                    self.received.pop_front();
                }
                if value >> 4 & 1 == 1 {
                    self.overrun = false;
                }
            }
            0x180 | 0x190 | 0x1A0 if value & 1 == 1 => {
                let slot = (offset - 0x180) / 0x10;
                let word = |index: u32| registers.get(CAN + offset + 4 * index);
                let frame = bxcan_frame([value, word(1), word(2), word(3)]);
                self.pending
                    .extend(frame.map(|frame| Pending { frame, slot }));
            }
            _ => {}
        }
    }

    fn written_fdcan(&mut self, offset: u32, value: u32, registers: &mut Registers, now_ns: f64) {
        /// Words of an element.
        const WORDS: u32 = 18;
        /// Places of the transmit buffers in the message memory.
        const TRANSMIT: u32 = 0x278;
        match offset {
            0x18 if self.off && value & 1 == 0 => self.off_until_ns = now_ns + RECOVERY_NS,
            0x50 => {
                if value >> 3 & 1 == 1 {
                    self.overrun = false;
                }
                registers.set(CAN + 0x50, 0);
            }
            0x94 => {
                self.received.pop_front();
                self.get_index = (self.get_index + 1) % QUEUE as u32;
            }
            0xCC => {
                for slot in (0..QUEUE as u32).filter(|slot| value >> slot & 1 == 1) {
                    let at = FDCAN_RAM + TRANSMIT + 4 * WORDS * slot;
                    let word = |index: u32| registers.get(at + 4 * index);
                    let frame = fdcan_frame([word(0), word(1), word(2), word(3)]);
                    self.pending
                        .extend(frame.map(|frame| Pending { frame, slot }));
                }
            }
            _ => {}
        }
    }

    /// A read of the message memory (FDCAN) at `offset`.
    #[must_use]
    pub fn read_memory(&self, offset: u32, registers: &Registers) -> u32 {
        const WORDS: u32 = 18;
        const FIFO_0: u32 = 0xB0;
        let stored = registers.get(FDCAN_RAM + offset);
        let Some(word) = offset.checked_sub(FIFO_0).map(|bytes| bytes / 4) else {
            return stored;
        };
        let (element, word) = (word / WORDS, word % WORDS);
        let place = (element + QUEUE as u32).wrapping_sub(self.get_index) % QUEUE as u32;
        match self.received.get(place as usize) {
            Some(frame) if element < QUEUE as u32 => {
                fdcan_words(frame).get(word as usize).copied().unwrap_or(0)
            }
            _ => stored,
        }
    }
}

fn data_words(frame: &Frame) -> [u32; 2] {
    let mut bytes = [0; 8];
    bytes[..frame.data().len()].copy_from_slice(frame.data());
    let (words, _) = bytes.as_chunks::<4>();
    [u32::from_le_bytes(words[0]), u32::from_le_bytes(words[1])]
}

fn frame_of(id: Option<Id>, remote: bool, length: u32, [low, high]: [u32; 2]) -> Option<Frame> {
    let length = length.min(8) as usize;
    if remote {
        return Frame::remote_frame(id?, length);
    }
    let bytes = (u64::from(high) << 32 | u64::from(low)).to_le_bytes();
    Frame::data_frame(id?, &bytes[..length])
}

fn extended(bits: u32) -> Option<Id> {
    ExtendedId::new(bits).map(Id::Extended)
}

fn standard(bits: u32) -> Option<Id> {
    StandardId::new(bits as u16).map(Id::Standard)
}

/// RIxR, RDTxR, RDLxR and RDHxR (RM0090, 32.9.3).
fn bxcan_words(frame: &Frame) -> [u32; 4] {
    let remote = u32::from(frame.is_remote()) << 1;
    let identifier = match frame.id() {
        Id::Standard(id) => u32::from(id.as_raw()) << 21,
        Id::Extended(id) => id.as_raw() << 3 | 1 << 2,
    };
    let [low, high] = data_words(frame);
    [identifier | remote, u32::from(frame.length()), low, high]
}

fn bxcan_frame([identifier, length, low, high]: [u32; 4]) -> Option<Frame> {
    let id = match identifier >> 2 & 1 {
        1 => extended(identifier >> 3),
        _ => standard(identifier >> 21),
    };
    frame_of(id, identifier >> 1 & 1 == 1, length & 0xF, [low, high])
}

/// An element of the message memory (RM0440, tables 398 and 402).
fn fdcan_words(frame: &Frame) -> [u32; 4] {
    let remote = u32::from(frame.is_remote()) << 29;
    let identifier = match frame.id() {
        Id::Standard(id) => u32::from(id.as_raw()) << 18,
        Id::Extended(id) => id.as_raw() | 1 << 30,
    };
    let [low, high] = data_words(frame);
    [
        identifier | remote,
        u32::from(frame.length()) << 16,
        low,
        high,
    ]
}

fn fdcan_frame([identifier, second, low, high]: [u32; 4]) -> Option<Frame> {
    let id = match identifier >> 30 & 1 {
        1 => extended(identifier & 0x1FFF_FFFF),
        _ => standard(identifier >> 18 & 0x7FF),
    };
    frame_of(
        id,
        identifier >> 29 & 1 == 1,
        second >> 16 & 0xF,
        [low, high],
    )
}

/// Bit rate and sampling point as set by the image, with their faults.
#[must_use]
pub fn audit(part: Part, registers: &Registers, apb1_hz: f64, crystal_hz: f64) -> Vec<String> {
    let (clock_hz, prescaler, before, after, jump) = match part {
        Part::Stm32f405 => {
            let field = |shift, width| registers.field(CAN + 0x1C, shift, width) + 1;
            (
                apb1_hz,
                field(0, 10),
                field(16, 4) + 1,
                field(20, 3),
                field(24, 2),
            )
        }
        Part::Stm32g474 => {
            let field = |shift, width| registers.field(CAN + 0x1C, shift, width) + 1;
            // `CCIPR`, `FDCANSEL`: the crystal or the bus's clock.
            let clock_hz = match registers.field(part.addresses().rcc + 0x88, 24, 2) {
                0 => crystal_hz,
                2 => apb1_hz,
                _ => 0.0,
            };
            (
                clock_hz,
                field(16, 9),
                field(8, 8) + 1,
                field(0, 7),
                field(25, 7),
            )
        }
    };
    let quanta = f64::from(before + after);
    let rate = clock_hz / f64::from(prescaler) / quanta;
    let sample = f64::from(before) / quanta;
    let mut findings = Vec::new();
    if (rate - 250e3).abs() > 125.0 {
        findings.push(format!("the bus runs at {rate} bit/s"));
    }
    if !(0.80..=0.90).contains(&sample) {
        findings.push(format!(
            "bits are sampled at {sample}; J1939-11 asks for 0.8 to 0.9"
        ));
    }
    if jump > after {
        findings.push("the jump width is longer than the second segment".into());
    }
    let silent = match part {
        Part::Stm32f405 => registers.field(CAN + 0x1C, 30, 2) != 0,
        Part::Stm32g474 => registers.bit(CAN + 0x18, 5) || registers.bit(CAN + 0x18, 7),
    };
    if silent {
        findings.push("the CAN controller is in a test mode".into());
    }
    findings
}
