//! Counts the ticks that a piece of code takes.
//!
//! The board's first CMSDK timer runs at 25 MHz. With QEMU's `-icount shift=6` an instruction takes 64 ns of
//! the emulator's time, so instructions = ticks * 5 / 8, to within one.

use core::hint::black_box;
use core::ptr::{read_volatile, write_volatile};

const CONTROL: *mut u32 = 0x4000_0000 as *mut u32;
const VALUE: *const u32 = 0x4000_0004 as *const u32;
const RELOAD: *mut u32 = 0x4000_0008 as *mut u32;
const ENABLE: u32 = 1;

/// The free-running timer, and what reading it costs.
pub struct Stopwatch {
    overhead: u32,
}

impl Stopwatch {
    /// Starts the timer and measures its own cost.
    pub fn start() -> Self {
        // SAFETY: the registers of CMSDK timer 0 of the AN386 image, which nothing else uses.
        unsafe {
            write_volatile(RELOAD, u32::MAX);
            write_volatile(CONTROL, ENABLE);
        }
        let mut watch = Self { overhead: 0 };
        watch.overhead = watch.ticks_of(|| ()).1;
        watch
    }

    /// Runs `work`; its result and the timer ticks that it took.
    pub fn ticks_of<R>(&self, work: impl FnOnce() -> R) -> (R, u32) {
        let before = now();
        let result = black_box(work());
        let after = now();
        // The timer counts down.
        (
            result,
            before.wrapping_sub(after).saturating_sub(self.overhead),
        )
    }
}

/// The timer.
pub fn now() -> u32 {
    // SAFETY: reading the timer's value has no side effect.
    unsafe { read_volatile(VALUE) }
}
