//! FDCAN as a classic CAN at 250 kbit/s on PA11 and PA12.
//!
//! Registers instead of the crate `fdcan`: it panics on frames longer than the given buffer, and its access to the
//! registers requires `unsafe`.

use embedded_can::{ExtendedId, Id, StandardId};
use hitch_protocols::can::Frame;
use stm32_metapac::can::vals::{Anfe, Anfs};
use stm32_metapac::{FDCAN1, FDCANRAM1};

/// FDCAN1 on PA11 and PA12 (data sheet, table 13).
pub const FUNCTION: u8 = 9;
/// Words of an element of the message memory: two of header, room for 64 bytes.
const ELEMENT_WORDS: usize = 18;
/// Elements in a queue.
const ELEMENTS: usize = 3;
/// Bits of the first word of an element (RM0440, table 402).
const EXTENDED: u32 = 1 << 30;
const REMOTE: u32 = 1 << 29;

/// Joins the bus.
pub fn join() {
    FDCAN1.cccr().modify(|w| w.set_init(true));
    while !FDCAN1.cccr().read().init() {}
    FDCAN1.cccr().modify(|w| w.set_cce(true));
    // 168 MHz / 42 = 4 MHz: 16 quanta per bit, sampled after 14 (87.5 %).
    FDCAN1.nbtp().write(|w| {
        w.set_nbrp(42 - 1);
        w.set_ntseg1(13 - 1);
        w.set_ntseg2(2 - 1);
        w.set_nsjw(2 - 1);
    });
    FDCAN1.rxgfc().modify(|w| {
        w.set_anfe(Anfe::ACCEPT_FIFO_0);
        w.set_anfs(Anfs::ACCEPT_FIFO_0);
    });
    FDCAN1.cccr().modify(|w| w.set_init(false));
}

/// Whether the hardware queue has dropped frames since the last call.
pub fn take_overrun() -> bool {
    let overrun = FDCAN1.rxfs(0).read().rfl();
    if overrun {
        // Writing one clears.
        FDCAN1.ir().write(|w| w.set_rfl(0, true));
    }
    overrun
}

/// Whether it has left the bus after too many errors.
pub fn is_off() -> bool {
    FDCAN1.psr().read().bo()
}

/// Queues a frame; false if the queue is full. After bus-off the controller is restarted.
pub fn send(frame: &Frame) -> bool {
    if FDCAN1.psr().read().bo() && FDCAN1.cccr().read().init() {
        // It takes part again after 129 times eleven recessive bits.
        FDCAN1.cccr().modify(|w| w.set_init(false));
    }
    let queue = FDCAN1.txfqs().read();
    if queue.tfqf() {
        return false;
    }
    let element = usize::from(queue.tfqpi()) % ELEMENTS;
    let header = match frame.id() {
        Id::Standard(id) => u32::from(id.as_raw()) << 18,
        Id::Extended(id) => EXTENDED | id.as_raw(),
    };
    let remote = if frame.is_remote() { REMOTE } else { 0 };
    let [a, b, c, d, e, f, g, h] = frame.padded();
    let words = [
        header | remote,
        u32::from(frame.length()) << 16,
        u32::from_le_bytes([a, b, c, d]),
        u32::from_le_bytes([e, f, g, h]),
    ];
    for (index, word) in words.into_iter().enumerate() {
        FDCANRAM1
            .txbuf(element * ELEMENT_WORDS + index)
            .write_value(word);
    }
    FDCAN1.txbar().write(|w| w.set_ar(element, true));
    true
}

/// The oldest frame in the hardware queue.
pub fn received() -> Option<Frame> {
    let state = FDCAN1.rxfs(0).read();
    if state.ffl() == 0 {
        return None;
    }
    let element = state.fgi();
    let word = |index| {
        FDCANRAM1
            .rxfifo0(usize::from(element) % ELEMENTS * ELEMENT_WORDS + index)
            .read()
    };
    let (header, second) = (word(0), word(1));
    let (low, high) = (word(2), word(3));
    FDCAN1.rxfa(0).write(|w| w.set_fai(element));
    frame(header, second >> 16 & 0xF, [low, high])
}

fn frame(header: u32, length: u32, [low, high]: [u32; 2]) -> Option<Frame> {
    let id = if header & EXTENDED != 0 {
        Id::Extended(ExtendedId::new(header & ExtendedId::MAX.as_raw())?)
    } else {
        Id::Standard(StandardId::new((header >> 18 & 0x7FF) as u16)?)
    };
    let [a, b, c, d] = low.to_le_bytes();
    let [e, f, g, h] = high.to_le_bytes();
    let (is_remote, length) = (header & REMOTE != 0, length.min(8) as u8);
    Frame::from_padded(id, is_remote, length, [a, b, c, d, e, f, g, h])
}
