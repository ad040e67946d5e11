//! STM32F405RG: clocks and peripherals.

mod can;
pub mod converters;
pub mod factory_reference;
pub mod flash;
pub mod register_check;
pub mod scaling;
pub mod slow_clock;

pub use can::Can;

use stm32_metapac::flash::vals::Latency;
use stm32_metapac::rcc::vals::{Pllm, Plln, Pllp, Pllq, Pllsrc, Ppre, Sw};
use stm32_metapac::{FLASH, RCC};

/// TIM1 on PA8 and PA9 (data sheet, table 9).
pub const TIMER_FUNCTION: u8 = 1;
/// Clock of TIM2: twice that of APB1.
pub const TIMER_HZ: u32 = 84_000_000;

/// 168 MHz from a crystal of 8 MHz, whose failure raises the non-maskable interrupt; APB1 runs at 42 MHz, APB2 at 84
/// MHz.
pub fn start_clocks() {
    RCC.cr().modify(|w| w.set_hseon(true));
    while !RCC.cr().read().hserdy() {}
    RCC.pllcfgr().write(|w| {
        w.set_pllsrc(Pllsrc::HSE);
        // 8 MHz / 4 * 168 / 2
        w.set_pllm(Pllm::DIV4);
        w.set_plln(Plln::MUL168);
        w.set_pllp(Pllp::DIV2);
        w.set_pllq(Pllq::DIV7);
    });
    RCC.cr().modify(|w| {
        w.set_pllon(true);
        w.set_csson(true);
    });
    while !RCC.cr().read().pllrdy() {}
    // The wait states have to be increased before the core clock.
    FLASH.acr().write(|w| {
        w.set_latency(Latency::WS5);
        w.set_prften(true);
        w.set_icen(true);
        w.set_dcen(true);
    });
    while FLASH.acr().read().latency() != Latency::WS5 {}
    RCC.cfgr().modify(|w| {
        w.set_ppre1(Ppre::DIV4);
        w.set_ppre2(Ppre::DIV2);
        w.set_sw(Sw::PLL1_P);
    });
    while RCC.cfgr().read().sws() != Sw::PLL1_P {}
    start_peripherals();
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
