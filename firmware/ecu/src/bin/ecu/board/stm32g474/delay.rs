//! Delays of the start-up code, by cycles of the core.

use embedded_hal::delay::DelayNs;

/// Cycles of the core in a microsecond.
const CYCLES_PER_US: u32 = 168;

/// Waits at least the requested time by counting cycles.
pub struct CycleDelay;

impl DelayNs for CycleDelay {
    fn delay_ns(&mut self, ns: u32) {
        cortex_m::asm::delay(ns.div_ceil(1_000).saturating_mul(CYCLES_PER_US));
    }
}
