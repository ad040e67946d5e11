//! Sources of the core's clock, by registers that both parts have.

use stm32_metapac::flash::vals::Latency;
use stm32_metapac::rcc::vals::Sw;
use stm32_metapac::{FLASH, RCC};

/// Runs the core from the crystal, which may have any frequency that the part allows. The wait states are those of the
/// full clock.
pub fn run_from_crystal(wait_states: Latency) {
    RCC.cr().modify(|w| w.set_hseon(true));
    while !RCC.cr().read().hserdy() {}
    FLASH.acr().write(|w| {
        w.set_latency(wait_states);
        w.set_prften(true);
        w.set_icen(true);
        w.set_dcen(true);
    });
    while FLASH.acr().read().latency() != wait_states {}
    switch_to(Sw::HSE);
}

/// Runs the core from the internal oscillator, and stops the crystal.
pub fn leave_crystal() {
    switch_to(Sw::HSI);
    RCC.cr().modify(|w| w.set_hseon(false));
}

/// Starts the PLL. `is_monitored`: a failure of the crystal raises the non-maskable interrupt.
pub fn start_pll(is_monitored: bool) {
    RCC.cr().modify(|w| {
        w.set_pllon(true);
        w.set_csson(is_monitored);
    });
    while !RCC.cr().read().pllrdy() {}
}

/// Runs the core from a clock that is ready.
pub fn switch_to(clock: Sw) {
    RCC.cfgr().modify(|w| w.set_sw(clock));
    while RCC.cfgr().read().sws() != clock {}
}
