//! STM32G474RE: clocks and peripherals. What differs between boards with this part is data of the board.

pub mod can;
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

use stm32_metapac::flash::vals::Latency;
use stm32_metapac::rcc::vals::{Fdcansel, Hpre, Pllm, Plln, Pllr, Pllsrc, Sw};
use stm32_metapac::{PWR, RCC, SYSCFG};

use crate::board::clock_source::Source;
use crate::board::core_clock;

/// TIM1 on PA8 and PA9 (data sheet, table 13).
pub const TIMER_FUNCTION: u8 = 6;
/// The internal oscillator.
pub const INTERNAL_HZ: u32 = 16_000_000;
/// Its lowest and highest rate, per mille of the nominal one: 15.88 to 16.08 MHz at 30 deg C, from there
/// -2.0 to 1.5 % over -40 to 125 deg C, and -0.1 to 0.05 % over the supply (DS12288, HSI16 oscillator characteristics).
pub const INTERNAL_RANGE_PER_MILLE: [u32; 2] = [972, 1_021];
/// Clock of TIM2 and TIM16: that of the core.
pub const TIMER_HZ: u32 = 168_000_000;

/// Wait states of the flash at the full clock.
pub const WAIT_STATES: Latency = Latency::WS4;

/// 168 MHz; the buses have the same clock. A failure of the crystal raises the non-maskable interrupt.
pub fn start_clocks(source: Source) {
    let is_crystal = source == Source::Crystal;
    if !is_crystal {
        core_clock::leave_crystal();
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
    core_clock::start_pll(is_crystal);
    // At half the clock for at least one microsecond (RM0440, 7.2.7).
    RCC.cfgr().modify(|w| w.set_hpre(Hpre::DIV2));
    core_clock::switch_to(Sw::PLL1_R);
    cortex_m::asm::delay(168);
    RCC.cfgr().modify(|w| w.set_hpre(Hpre::DIV1));
    start_peripherals();
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
