//! Cause of the last reset.

use stm32_metapac::RCC;

/// Bits of `RCC_CSR`, the same on both parts (RM0090, 7.3.21; RM0440, 7.4.28).
const WATCHDOG: u32 = 1 << 29;
const SOFTWARE: u32 = 1 << 28;
const POWER: u32 = 1 << 27;

/// The cause as text, read once: the flags are cleared afterwards.
pub fn reset_cause() -> &'static str {
    let flags = RCC.csr().read().0;
    RCC.csr().modify(|w| w.set_rmvf(true));
    // Power-up sets the other flags as well.
    match flags {
        _ if flags & POWER != 0 => "power or brown-out",
        _ if flags & WATCHDOG != 0 => "watchdog",
        _ if flags & SOFTWARE != 0 => "software",
        _ => "pin",
    }
}
