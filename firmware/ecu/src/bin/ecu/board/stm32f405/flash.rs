//! Sectors 8 to 11, of 128 KiB each: two for the log of faults, two for the calibration.
//!
//! The program can't run from flash while a sector is erased (1 to 2 s): the ECU only erases while it is locked or starts, the
//! watchdog gets a longer period first, and the loop that waits runs from RAM.

use stm32_metapac::FLASH;
use stm32_metapac::flash::vals::Psize;

use crate::board::watchdog::with_long_period;

/// First address.
pub const BASE: usize = 0x0808_0000;
/// Sectors of the log of faults, which come first.
pub const LOG_PIECES: usize = 2;
/// Sectors of the calibration.
pub const CALIBRATION_PIECES: usize = 2;
/// Bytes of a sector.
pub const PIECE_BYTES: usize = 128 * 1024;
/// Bytes that are programmed together.
pub const WORD_BYTES: usize = 4;

const FIRST_SECTOR: u8 = 8;

/// Lets the flash be changed (RM0090, 3.6.1).
pub fn unlock() {
    FLASH.keyr().write_value(0x4567_0123);
    FLASH.keyr().write_value(0xCDEF_89AB);
    FLASH.cr().modify(|w| w.set_psize(Psize::PSIZE32));
}

/// Erases a sector, by its number from [`BASE`] on.
pub fn erase_piece(number: u8) {
    FLASH.cr().modify(|w| {
        w.set_ser(true);
        w.set_snb(FIRST_SECTOR + number);
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

/// Locks the flash again, and says whether all went well since it was unlocked.
pub fn finish() -> bool {
    let status = FLASH.sr().read();
    // Writing ones clears.
    FLASH.sr().write_value(status);
    FLASH.cr().modify(|w| w.set_lock(true));
    !(status.wrperr() || status.pgaerr() || status.pgperr() || status.pgserr())
}

/// The layout of this flash doesn't depend on option bytes.
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

/// Starts what the control register is set to, and waits for its end. Runs from RAM: the flash can't be read meanwhile.
#[inline(never)]
#[unsafe(link_section = ".data.start_and_wait")]
fn start_and_wait() {
    FLASH.cr().modify(|w| w.set_strt(true));
    while FLASH.sr().read().bsy() {}
}

fn wait() {
    while FLASH.sr().read().bsy() {}
}
