//! The last four pages of the second bank, of 2 KiB each. The program runs on from the first bank meanwhile.

use stm32_metapac::FLASH;

/// First address.
pub const BASE: usize = 0x0807_E000;
/// Pages.
pub const PIECES: usize = 4;
/// Bytes of a page.
pub const PIECE_BYTES: usize = 2 * 1024;
/// Bytes that are programmed together.
pub const WORD_BYTES: usize = 8;

/// Of 128 pages in the bank.
const FIRST_PAGE: u8 = 124;

/// Lets the flash be changed (RM0440, 3.3.5).
pub fn unlock() {
    FLASH.keyr().write_value(0x4567_0123);
    FLASH.keyr().write_value(0xCDEF_89AB);
}

/// Erases a page, by its number in the calibration's place.
pub fn erase_piece(number: u8) {
    FLASH.cr().modify(|w| {
        w.set_per(true);
        w.set_bker(true);
        w.set_pnb(FIRST_PAGE + number);
    });
    FLASH.cr().modify(|w| w.set_strt(true));
    super::super::watchdog::with_patience(wait);
    FLASH.cr().modify(|w| w.set_per(false));
}

/// Programs a double word.
///
/// # Safety
/// `address` is that of an aligned double word that belongs to the calibration.
pub unsafe fn program(address: usize, word: &[u8; WORD_BYTES]) {
    let [a, b, c, d, e, f, g, h] = *word;
    FLASH.cr().modify(|w| w.set_pg(true));
    // SAFETY: the caller's promise; programming is switched on, so the two writes, in this order, end in the flash.
    unsafe {
        (address as *mut u32).write_volatile(u32::from_le_bytes([a, b, c, d]));
        ((address + 4) as *mut u32).write_volatile(u32::from_le_bytes([e, f, g, h]));
    }
    wait();
    FLASH.cr().modify(|w| w.set_pg(false));
}

/// Locks the flash again, and says whether all went well since it was unlocked.
pub fn finish() -> bool {
    let status = FLASH.sr().read();
    // Writing ones clears.
    FLASH.sr().write_value(status);
    FLASH.cr().modify(|w| w.set_lock(true));
    !(status.operr() || status.wrperr() || status.pgaerr() || status.pgserr())
}

/// Opens the option bytes (RM0440, 3.4.2).
pub fn unlock_options() {
    FLASH.optkeyr().write_value(0x0819_2A3B);
    FLASH.optkeyr().write_value(0x4C5D_6E7F);
}

fn wait() {
    while FLASH.sr().read().bsy() {}
}
