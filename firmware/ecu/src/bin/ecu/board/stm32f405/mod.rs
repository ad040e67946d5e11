//! STM32F405RG: clocks and peripherals.

pub mod can;
pub mod converters;
pub mod factory_reference;
pub mod flash;
pub mod register_check;
mod scaling;
pub mod slow_clock;

pub use scaling::SCALING;

use stm32_metapac::RCC;
use stm32_metapac::flash::vals::Latency;
use stm32_metapac::rcc::vals::{Pllm, Plln, Pllp, Pllq, Pllsrc, Ppre, Sw};

use crate::board::clock_source::Source;
use crate::board::core_clock;

/// TIM1 on PA8 and PA9 (data sheet, table 9).
pub const TIMER_FUNCTION: u8 = 1;
/// The crystal that the image is made for. The part allows up to 26 MHz.
pub const CRYSTAL_HZ: u32 = 8_000_000;
/// The internal oscillator.
pub const INTERNAL_HZ: u32 = 16_000_000;
/// Its lowest and highest rate, per mille of the nominal one: 1 % at 25 deg C, -4 to 4 % over -10 to 85, -8 to
/// 4.5 % over -40 to 105 deg C (DS8626, HSI oscillator characteristics).
pub const INTERNAL_RANGE_PER_MILLE: [u32; 2] = [920, 1_045];
/// Clock of TIM2 and TIM5: twice that of APB1.
pub const TIMER_HZ: u32 = 84_000_000;

/// Wait states of the flash at the full clock.
pub const WAIT_STATES: Latency = Latency::WS5;

/// 168 MHz; APB1 runs at 42 MHz, APB2 at 84 MHz. A failure of the crystal raises the non-maskable interrupt.
pub fn start_clocks(source: Source) {
    let is_crystal = source == Source::Crystal;
    if !is_crystal {
        core_clock::leave_crystal();
    }
    RCC.pllcfgr().write(|w| {
        // 8 MHz / 4 or 16 MHz / 8, * 168 / 2
        w.set_pllsrc(if is_crystal { Pllsrc::HSE } else { Pllsrc::HSI });
        w.set_pllm(if is_crystal { Pllm::DIV4 } else { Pllm::DIV8 });
        w.set_plln(Plln::MUL168);
        w.set_pllp(Pllp::DIV2);
        w.set_pllq(Pllq::DIV7);
    });
    core_clock::start_pll(is_crystal);
    RCC.cfgr().modify(|w| {
        w.set_ppre1(Ppre::DIV4);
        w.set_ppre2(Ppre::DIV2);
    });
    core_clock::switch_to(Sw::PLL1_P);
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
