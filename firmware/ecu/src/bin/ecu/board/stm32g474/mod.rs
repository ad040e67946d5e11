//! STM32G474RE: clocks and peripherals. What differs between boards with this part is data of the board.

mod can;
pub mod converters;
mod delay;
pub mod factory_reference;
pub mod flash;
pub mod register_check;
pub mod slow_clock;

#[cfg(not(feature = "nucleo-g474re"))]
#[path = "ecu_board.rs"]
mod board_data;
#[cfg(feature = "nucleo-g474re")]
#[path = "nucleo_g474re.rs"]
mod board_data;

use board_data::CRYSTAL_DIVIDER;
pub use board_data::{CRYSTAL_HZ, SCALING};
pub use can::Can;

use stm32_metapac::flash::vals::Latency;
use stm32_metapac::rcc::vals::{Fdcansel, Hpre, Pllm, Plln, Pllr, Pllsrc, Sw};
use stm32_metapac::{FLASH, PWR, RCC, SYSCFG};

use crate::board::clock_source::Source;

/// TIM1 on PA8 and PA9 (data sheet, table 13).
pub const TIMER_FUNCTION: u8 = 6;
/// The internal oscillator.
pub const INTERNAL_HZ: u32 = 16_000_000;
/// Its lowest and highest rate, per mille of the nominal one: 15.88 to 16.08 MHz at 30 deg C, from there
/// -2.0 to 1.5 % over -40 to 125 deg C, and -0.1 to 0.05 % over the supply (DS12288, HSI16 oscillator characteristics).
pub const INTERNAL_RANGE_PER_MILLE: [u32; 2] = [972, 1_021];
/// Clock of TIM2 and TIM16: that of the core.
pub const TIMER_HZ: u32 = 168_000_000;

/// Runs the core from the crystal, which may have any frequency that the part allows, up to 48 MHz. The wait states are
/// those of the full clock.
pub fn run_from_crystal() {
    RCC.cr().modify(|w| w.set_hseon(true));
    while !RCC.cr().read().hserdy() {}
    FLASH.acr().write(|w| {
        w.set_latency(Latency::WS4);
        w.set_prften(true);
        w.set_icen(true);
        w.set_dcen(true);
    });
    while FLASH.acr().read().latency() != Latency::WS4 {}
    switch_to(Sw::HSE);
}

/// 168 MHz; the buses have the same clock. A failure of the crystal raises the non-maskable interrupt.
pub fn start_clocks(source: Source) {
    let is_crystal = source == Source::Crystal;
    if !is_crystal {
        switch_to(Sw::HSI);
        RCC.cr().modify(|w| w.set_hseon(false));
    }
    RCC.apb1enr1().modify(|w| w.set_pwren(true));
    let _ = RCC.apb1enr1().read();
    // Boost, for clocks above 150 MHz (RM0440, 6.1.5): `R1MODE` is bit 8, where stm32-metapac 21 has bit 0.
    PWR.cr5().modify(|w| w.0 &= !(1 << 8));
    RCC.pllcfgr().write(|w| {
        // 4 MHz of either source, * 84 / 2
        w.set_pllsrc(if is_crystal { Pllsrc::HSE } else { Pllsrc::HSI });
        w.set_pllm(if is_crystal {
            CRYSTAL_DIVIDER
        } else {
            Pllm::DIV4
        });
        w.set_plln(Plln::MUL84);
        w.set_pllr(Pllr::DIV2);
        w.set_pllren(true);
    });
    RCC.cr().modify(|w| {
        w.set_pllon(true);
        w.set_csson(is_crystal);
    });
    while !RCC.cr().read().pllrdy() {}
    // At half the clock for at least one microsecond (RM0440, 7.2.7).
    RCC.cfgr().modify(|w| w.set_hpre(Hpre::DIV2));
    switch_to(Sw::PLL1_R);
    cortex_m::asm::delay(168);
    RCC.cfgr().modify(|w| w.set_hpre(Hpre::DIV1));
    start_peripherals();
}

fn switch_to(clock: Sw) {
    RCC.cfgr().modify(|w| w.set_sw(clock));
    while RCC.cfgr().read().sws() != clock {}
}

fn start_peripherals() {
    RCC.ccipr().modify(|w| w.set_fdcansel(Fdcansel::PCLK1));
    RCC.ahb2enr().modify(|w| {
        w.set_gpioaen(true);
        w.set_gpioben(true);
        w.set_gpiocen(true);
        w.set_adc12en(true);
        w.set_adc345en(true);
    });
    RCC.apb1enr1().modify(|w| {
        w.set_tim2en(true);
        w.set_fdcanen(true);
    });
    RCC.apb2enr().modify(|w| {
        w.set_tim1en(true);
        w.set_syscfgen(true);
    });
    // A clock is active after two cycles; reading back takes as long.
    let _ = RCC.apb2enr().read();
    // A lockup of the core switches the outputs off, as does a nested fault.
    SYSCFG.cfgr2().modify(|w| w.set_cll(true));
}
