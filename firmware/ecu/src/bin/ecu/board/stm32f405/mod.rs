//! STM32F405RG: clocks and peripherals.

mod can;
pub mod converters;
pub mod factory_reference;
pub mod flash;
pub mod register_check;
mod scaling;
pub mod slow_clock;

pub use can::Can;
pub use scaling::SCALING;

use stm32_metapac::flash::vals::Latency;
use stm32_metapac::rcc::vals::{Pllm, Plln, Pllp, Pllq, Pllsrc, Ppre, Sw};
use stm32_metapac::{FLASH, RCC};

use crate::board::clock_source::Source;

/// TIM1 on PA8 and PA9 (data sheet, table 9).
pub const TIMER_FUNCTION: u8 = 1;
/// The crystal that the image is made for.
pub const CRYSTAL_HZ: u32 = 8_000_000;
/// The internal oscillator.
pub const INTERNAL_HZ: u32 = 16_000_000;
/// Its lowest and highest rate, per mille of the nominal one: 1 % at 25 deg C, -4 to 4 % over -10 to 85, -8 to
/// 4.5 % over -40 to 105 deg C (DS8626, HSI oscillator characteristics).
pub const INTERNAL_RANGE_PER_MILLE: [u32; 2] = [920, 1_045];
/// Clock of TIM2 and TIM5: twice that of APB1.
pub const TIMER_HZ: u32 = 84_000_000;

/// Runs the core from the crystal, which may have any frequency that the part allows, up to 26 MHz. The wait states are
/// those of the full clock.
pub fn run_from_crystal() {
    RCC.cr().modify(|w| w.set_hseon(true));
    while !RCC.cr().read().hserdy() {}
    FLASH.acr().write(|w| {
        w.set_latency(Latency::WS5);
        w.set_prften(true);
        w.set_icen(true);
        w.set_dcen(true);
    });
    while FLASH.acr().read().latency() != Latency::WS5 {}
    switch_to(Sw::HSE);
}

/// 168 MHz; APB1 runs at 42 MHz, APB2 at 84 MHz. A failure of the crystal raises the non-maskable interrupt.
pub fn start_clocks(source: Source) {
    let is_crystal = source == Source::Crystal;
    if !is_crystal {
        switch_to(Sw::HSI);
        RCC.cr().modify(|w| w.set_hseon(false));
    }
    RCC.pllcfgr().write(|w| {
        // 8 MHz / 4 or 16 MHz / 8, * 168 / 2
        w.set_pllsrc(if is_crystal { Pllsrc::HSE } else { Pllsrc::HSI });
        w.set_pllm(if is_crystal { Pllm::DIV4 } else { Pllm::DIV8 });
        w.set_plln(Plln::MUL168);
        w.set_pllp(Pllp::DIV2);
        w.set_pllq(Pllq::DIV7);
    });
    RCC.cr().modify(|w| {
        w.set_pllon(true);
        w.set_csson(is_crystal);
    });
    while !RCC.cr().read().pllrdy() {}
    RCC.cfgr().modify(|w| {
        w.set_ppre1(Ppre::DIV4);
        w.set_ppre2(Ppre::DIV2);
    });
    switch_to(Sw::PLL1_P);
    start_peripherals();
}

fn switch_to(clock: Sw) {
    RCC.cfgr().modify(|w| w.set_sw(clock));
    while RCC.cfgr().read().sws() != clock {}
}

fn start_peripherals() {
    RCC.ahb1enr().modify(|w| {
        w.set_gpioaen(true);
        w.set_gpioben(true);
        w.set_gpiocen(true);
    });
    RCC.apb1enr().modify(|w| {
        w.set_tim2en(true);
        w.set_can1en(true);
    });
    RCC.apb2enr().modify(|w| {
        w.set_tim1en(true);
        w.set_adc1en(true);
        w.set_adc2en(true);
        w.set_adc3en(true);
    });
    // A clock is active after two cycles (erratum 2.1.13); reading back takes as long.
    let _ = RCC.apb2enr().read();
}
