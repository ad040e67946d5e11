//! Sectors 7 to 11, of 128 KiB each: one for the key, two for the fault log, two for the calibration.
//!
//! The program cannot run from flash while a sector is erased (1 to 2 s). The ECU therefore erases only while it is
//! locked or at the start, with a longer period of the watchdog, and the wait loop runs from RAM.

use stm32_metapac::FLASH;
use stm32_metapac::flash::vals::Psize;

use crate::board::watchdog::with_long_period;

/// First address.
pub const BASE: usize = 0x0806_0000;
/// Sectors of the key, which are first.
pub const KEY_PIECES: usize = 1;
/// Sectors of the fault log.
pub const LOG_PIECES: usize = 2;
/// Sectors of the calibration.
pub const CALIBRATION_PIECES: usize = 2;
/// Bytes of a sector.
pub const PIECE_BYTES: usize = 128 * 1024;
/// Bytes of a programming unit.
pub const WORD_BYTES: usize = 4;

const FIRST_SECTOR: u8 = 7;

/// Unlocks the flash (RM0090, 3.6.1).
pub fn unlock() {
    FLASH.keyr().write_value(0x4567_0123);
    FLASH.keyr().write_value(0xCDEF_89AB);
    FLASH.cr().modify(|w| w.set_psize(Psize::PSIZE32));
}

/// Erases a sector, by its number from [`BASE`] on.
pub fn erase_piece(number: u8) {
    FLASH.cr().modify(|w| {
        w.set_ser(true);
        w.set_snb(FIRST_SECTOR.saturating_add(number));
    });
    with_long_period(start_and_wait);
    FLASH.cr().modify(|w| w.set_ser(false));
}

/// Programs a word.
///
/// # Safety
/// `address` is that of an aligned word from [`BASE`] on.
pub unsafe fn program(address: usize, word: &[u8; WORD_BYTES]) {
    FLASH.cr().modify(|w| w.set_pg(true));
    // SAFETY: the caller's promise; programming is switched on, so the write ends in the flash.
    unsafe { (address as *mut u32).write_volatile(u32::from_le_bytes(*word)) };
    wait();
    FLASH.cr().modify(|w| w.set_pg(false));
}

/// Locks the flash again; returns whether all operations since unlocking succeeded.
pub fn finish() -> bool {
    let status = FLASH.sr().read();
    // Writing ones clears.
    FLASH.sr().write_value(status);
    FLASH.cr().modify(|w| w.set_lock(true));
    !(status.wrperr() || status.pgaerr() || status.pgperr() || status.pgserr())
}

/// The layout of this flash does not depend on option bytes.
pub const fn is_usable() -> bool {
    true
}

/// This flash has no error correction: an interrupt has another cause.
pub const fn note_damaged_read() -> bool {
    false
}

/// This flash has no error correction.
pub const fn take_damaged_read() -> bool {
    false
}

/// Starts the operation in the control register, and waits for its end. Runs from RAM: the flash is not readable
/// meanwhile.
#[inline(never)]
#[unsafe(link_section = ".data.start_and_wait")]
fn start_and_wait() {
    FLASH.cr().modify(|w| w.set_strt(true));
    while FLASH.sr().read().bsy() {}
}

fn wait() {
    while FLASH.sr().read().bsy() {}
}
