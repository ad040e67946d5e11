//! STM32G474RE: clocks and peripherals.

mod can;
pub mod converters;
mod delay;
pub mod factory_reference;
pub mod flash;
pub mod register_check;
pub mod scaling;
pub mod slow_clock;

pub use can::Can;

use stm32_metapac::flash::vals::Latency;
use stm32_metapac::rcc::vals::{Fdcansel, Hpre, Pllm, Plln, Pllr, Pllsrc, Sw};
use stm32_metapac::{FLASH, PWR, RCC, SYSCFG};

/// TIM1 on PA8 and PA9 (data sheet, table 13).
pub const TIMER_FUNCTION: u8 = 6;
/// Clock of TIM2: that of the core.
pub const TIMER_HZ: u32 = 168_000_000;

/// 168 MHz from a crystal of 8 MHz, whose failure raises the non-maskable interrupt. The buses have the same clock; the
/// CAN controller is clocked by the crystal.
pub fn start_clocks() {
    RCC.apb1enr1().modify(|w| w.set_pwren(true));
    let _ = RCC.apb1enr1().read();
    // Boost, for clocks above 150 MHz (RM0440, 6.1.5): `R1MODE` is bit 8, where stm32-metapac 21 has bit 0.
    PWR.cr5().modify(|w| w.0 &= !(1 << 8));
    RCC.cr().modify(|w| w.set_hseon(true));
    while !RCC.cr().read().hserdy() {}
    RCC.pllcfgr().write(|w| {
        w.set_pllsrc(Pllsrc::HSE);
        // 8 MHz / 2 * 84 / 2
        w.set_pllm(Pllm::DIV2);
        w.set_plln(Plln::MUL84);
        w.set_pllr(Pllr::DIV2);
        w.set_pllren(true);
    });
    RCC.cr().modify(|w| {
        w.set_pllon(true);
        w.set_csson(true);
    });
    while !RCC.cr().read().pllrdy() {}
    // The wait states have to be increased before the core clock.
    FLASH.acr().write(|w| {
        w.set_latency(Latency::WS4);
        w.set_prften(true);
        w.set_icen(true);
        w.set_dcen(true);
    });
    while FLASH.acr().read().latency() != Latency::WS4 {}
    // At half the clock for at least one microsecond (RM0440, 7.2.7).
    RCC.cfgr().modify(|w| w.set_hpre(Hpre::DIV2));
    RCC.cfgr().modify(|w| w.set_sw(Sw::PLL1_R));
    while RCC.cfgr().read().sws() != Sw::PLL1_R {}
    cortex_m::asm::delay(168);
    RCC.cfgr().modify(|w| w.set_hpre(Hpre::DIV1));
    start_peripherals();
}

fn start_peripherals() {
    RCC.ccipr().modify(|w| w.set_fdcansel(Fdcansel::HSE));
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
