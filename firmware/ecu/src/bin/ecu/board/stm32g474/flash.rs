//! The last seven pages of the second bank, of 2 KiB each: one for the key, two for the fault log, four for the
//! calibration. The program continues from the first bank meanwhile.

use core::sync::atomic::{AtomicBool, Ordering};

use stm32_metapac::FLASH;

use crate::board::watchdog::with_long_period;

/// First address.
pub const BASE: usize = 0x0807_C800;
/// Pages of the key, which are first.
pub const KEY_PIECES: usize = 1;
/// Pages of the fault log.
pub const LOG_PIECES: usize = 2;
/// Pages of the calibration.
pub const CALIBRATION_PIECES: usize = 4;
/// Bytes of a page.
pub const PIECE_BYTES: usize = 2 * 1024;
/// Bytes of a programming unit.
pub const WORD_BYTES: usize = 8;

/// Index of the first page, of 128 pages in the bank.
const FIRST_PAGE: u8 = 121;

/// Unlocks the flash (RM0440, 3.3.5).
pub fn unlock() {
    FLASH.keyr().write_value(0x4567_0123);
    FLASH.keyr().write_value(0xCDEF_89AB);
}

/// Erases a page, by its number from [`BASE`] on.
pub fn erase_piece(number: u8) {
    FLASH.cr().modify(|w| {
        w.set_per(true);
        w.set_bker(true);
        w.set_pnb(FIRST_PAGE.saturating_add(number));
    });
    // 22 ms; the program continues from the other bank.
    with_long_period(|| {
        FLASH.cr().modify(|w| w.set_strt(true));
        wait();
    });
    FLASH.cr().modify(|w| w.set_per(false));
}

/// Programs a double word.
///
/// # Safety
/// `address` is that of an aligned double word from [`BASE`] on.
pub unsafe fn program(address: usize, word: &[u8; WORD_BYTES]) {
    let [a, b, c, d, e, f, g, h] = *word;
    FLASH.cr().modify(|w| w.set_pg(true));
    // SAFETY: the caller's promise; programming is switched on, so the two writes, in this order, end in the flash.
    unsafe {
        (address as *mut u32).write_volatile(u32::from_le_bytes([a, b, c, d]));
        (address.saturating_add(4) as *mut u32).write_volatile(u32::from_le_bytes([e, f, g, h]));
    }
    wait();
    FLASH.cr().modify(|w| w.set_pg(false));
}

/// Locks the flash again; returns whether all operations since unlocking succeeded.
pub fn finish() -> bool {
    let status = FLASH.sr().read();
    // Writing ones clears.
    FLASH.sr().write_value(status);
    FLASH.cr().modify(|w| w.set_lock(true));
    !(status.operr() || status.wrperr() || status.pgaerr() || status.pgserr())
}

/// Whether the flash has two banks with pages of 2 KiB (option bit `DBANK`, as delivered). With one bank the pages have
/// other addresses, and erasing by these numbers could destroy the program.
pub fn is_usable() -> bool {
    FLASH.optr().read().dbank()
}

/// Set by the non-maskable interrupt.
static DAMAGED: AtomicBool = AtomicBool::new(false);

/// Whether the error correction of a read has failed since the last call: its programming was interrupted.
pub fn take_damaged_read() -> bool {
    // The interrupt is taken before this instruction.
    cortex_m::asm::dsb();
    cortex_m::asm::isb();
    let damaged = DAMAGED.load(Ordering::Relaxed);
    DAMAGED.store(false, Ordering::Relaxed);
    damaged
}

/// Handles a non-maskable interrupt caused by failed error correction from [`BASE`]: it is recorded, and the flag is
/// cleared.
pub fn note_damaged_read() -> bool {
    /// Offset of the data in the second bank.
    const OFFSET: u32 = BASE as u32 - 0x0804_0000;
    let status = FLASH.eccr().read();
    if !status.eccd() || !status.bk_ecc() || status.sysf_ecc() || status.addr_ecc() < OFFSET {
        return false;
    }
    DAMAGED.store(true, Ordering::Relaxed);
    // Writing one clears.
    FLASH.eccr().write(|w| w.set_eccd(true));
    true
}

fn wait() {
    while FLASH.sr().read().bsy() {}
}
