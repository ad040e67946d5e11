//! bxCAN at 250 kbit/s on PA11 and PA12.
//!
//! Registers instead of the crate `bxcan`: the ECU needs only a small part of it, and the access of that crate to the
//! registers requires `unsafe`.

use embedded_can::{ExtendedId, Id, StandardId};
use hitch_protocols::can::Frame;
use stm32_metapac::CAN1;
use stm32_metapac::can::vals::{Ide, Rtr};

/// CAN1 on PA11 and PA12 (data sheet, table 9).
pub const FUNCTION: u8 = 9;

/// Joins the bus.
pub fn join() {
    CAN1.mcr().modify(|w| {
        w.set_sleep(false);
        w.set_inrq(true);
    });
    while !CAN1.msr().read().inak() {}
    CAN1.mcr().modify(|w| {
        // Automatic recovery after bus-off, and transmission in the order of requests.
        w.set_abom(true);
        w.set_txfp(true);
    });
    // 42 MHz / 12 = 3.5 MHz: 14 quanta per bit, sampled after 12 (86 %; J1939-11 requires 80 to 90 %).
    CAN1.btr().write(|w| {
        w.set_brp(12 - 1);
        w.set_ts(0, 11 - 1);
        w.set_ts(1, 2 - 1);
        w.set_sjw(2 - 1);
    });
    accept_everything();
    CAN1.mcr().modify(|w| w.set_inrq(false));
}

/// Whether the hardware queue has dropped frames since the last call.
pub fn take_overrun() -> bool {
    let overrun = CAN1.rfr(0).read().fovr();
    if overrun {
        // Writing one clears.
        CAN1.rfr(0).write(|w| w.set_fovr(true));
    }
    overrun
}

/// Whether it has left the bus after too many errors.
pub fn is_off() -> bool {
    CAN1.esr().read().boff()
}

/// Queues a frame; false if no mailbox is free.
pub fn send(frame: &Frame) -> bool {
    let status = CAN1.tsr().read();
    let free = usize::from(status.code()).min(2);
    if !status.tme(free) {
        return false;
    }
    let mailbox = CAN1.tx(free);
    let [a, b, c, d, e, f, g, h] = frame.padded();
    mailbox.tdtr().write(|w| w.set_dlc(frame.length()));
    mailbox
        .tdlr()
        .write(|w| w.0 = u32::from_le_bytes([a, b, c, d]));
    mailbox
        .tdhr()
        .write(|w| w.0 = u32::from_le_bytes([e, f, g, h]));
    mailbox.tir().write(|w| {
        match frame.id() {
            Id::Standard(id) => w.set_stid(id.as_raw()),
            Id::Extended(id) => {
                w.set_ide(Ide::EXTENDED);
                w.set_stid((id.as_raw() >> 18) as u16);
                w.set_exid(id.as_raw() & 0x3_FFFF);
            }
        }
        w.set_rtr(if frame.is_remote() {
            Rtr::REMOTE
        } else {
            Rtr::DATA
        });
        w.set_txrq(true);
    });
    true
}

/// The oldest frame in the hardware queue.
pub fn received() -> Option<Frame> {
    if CAN1.rfr(0).read().fmp() == 0 {
        return None;
    }
    let mailbox = CAN1.rx(0);
    let (rir, length) = (mailbox.rir().read(), mailbox.rdtr().read().dlc().min(8));
    let id = match rir.ide() {
        Ide::EXTENDED => {
            let bits = (u32::from(rir.stid()) << 18) | rir.exid();
            ExtendedId::new(bits).map(Id::Extended)
        }
        Ide::STANDARD => StandardId::new(rir.stid()).map(Id::Standard),
    };
    let [a, b, c, d] = mailbox.rdlr().read().0.to_le_bytes();
    let [e, f, g, h] = mailbox.rdhr().read().0.to_le_bytes();
    CAN1.rfr(0).write(|w| w.set_rfom(true));
    let is_remote = rir.rtr() == Rtr::REMOTE;
    Frame::from_padded(id?, is_remote, length, [a, b, c, d, e, f, g, h])
}

/// One 32-bit filter that passes all frames, into FIFO 0.
fn accept_everything() {
    CAN1.fmr().modify(|w| w.set_finit(true));
    CAN1.fs1r().modify(|w| w.set_fsc(0, true));
    CAN1.fb(0).fr1().write(|w| w.0 = 0);
    CAN1.fb(0).fr2().write(|w| w.0 = 0);
    CAN1.fa1r().modify(|w| w.set_fact(0, true));
    CAN1.fmr().modify(|w| w.set_finit(false));
}
