//! How much of the stack was ever used.

use core::ptr::read_volatile;

use cortex_m_rt::STACK_PAINT_VALUE;

unsafe extern "C" {
    static _stack_start: u32;
    static _stack_end: u32;
}

/// Bytes between the stack's top and the deepest word that lost the paint it got at reset.
pub fn high_water_mark() -> u32 {
    let top = (&raw const _stack_start) as usize;
    let mut address = (&raw const _stack_end) as usize;
    // SAFETY: every word between the two symbols is RAM; the linker script aligns both.
    while address < top && unsafe { read_volatile(address as *const u32) } == STACK_PAINT_VALUE {
        address += size_of::<u32>();
    }
    (top - address) as u32
}
