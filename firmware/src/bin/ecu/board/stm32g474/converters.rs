//! Which channels the signals are on the STM32G474, and how its converters are set up and asked.

use stm32_metapac::adc::Adc;
use stm32_metapac::adc::vals::{Adcaldif, Exten, SampleTime};
use stm32_metapac::adccommon::vals::Ckmode;
use stm32_metapac::{ADC12_COMMON, ADC345_COMMON, GPIOA, GPIOB, GPIOC};

use crate::board::pins;

/// TIM1_TRGO for ADC1 and 2 and for ADC3 (RM0440, tables of `JEXTSEL`).
const TIM1_TRGO: u8 = 0;
/// Lift current PA2, angle PA0, upper-limit dial PA3, supply PB0.
pub const FIRST: [u8; 4] = [3, 1, 4, 15];
/// Lowering current PC0, lever PA1, lowering dial PC1, cylinder pressure PC2.
pub const SECOND: [u8; 4] = [6, 2, 7, 8];
/// Pump pressure PB1.
pub const THIRD: [u8; 1] = [1];

/// Makes the pins analogue and sets the converters' clock.
pub fn start_pins_and_clocks() {
    for pin in 0..=3 {
        pins::analog(GPIOA, pin);
    }
    for pin in 0..=2 {
        pins::analog(GPIOC, pin);
    }
    for pin in 0..=1 {
        pins::analog(GPIOB, pin);
    }
    // 168 MHz / 4 = 42 MHz, of 60 MHz allowed.
    for common in [ADC12_COMMON, ADC345_COMMON] {
        common.ccr().modify(|w| w.set_ckmode(Ckmode::SYNC_DIV4));
    }
}

/// True once a sequence has run.
pub fn is_done(adc: Adc) -> bool {
    adc.isr().read().jeos()
}

/// Makes ready for the next one.
pub fn clear(adc: Adc) {
    // Writing one clears.
    adc.isr().write(|w| w.set_jeos(true));
}

/// Four channels take 4 * (92.5 + 12.5) / 42 MHz = 10 us.
pub fn start_sequence(adc: Adc, channels: &[u8]) {
    wake_and_calibrate(adc);
    for &channel in channels {
        let channel = usize::from(channel);
        match channel.checked_sub(10) {
            Some(high) => adc
                .smpr2()
                .modify(|w| w.set_smp(high, SampleTime::CYCLES92_5)),
            None => adc
                .smpr()
                .modify(|w| w.set_smp(channel, SampleTime::CYCLES92_5)),
        }
    }
    adc.isr().write(|w| w.set_adrdy(true));
    adc.cr().modify(|w| w.set_aden(true));
    while !adc.isr().read().adrdy() {}
    // Without the queue of contexts the sequence stays when it has run.
    adc.cfgr().modify(|w| w.set_jqdis(true));
    adc.jsqr().write(|w| {
        w.set_jl(channels.len() as u8 - 1);
        w.set_jextsel(TIM1_TRGO);
        w.set_jexten(Exten::RISING_EDGE);
        for (index, &channel) in channels.iter().enumerate() {
            w.set_jsq(index, channel);
        }
    });
    adc.cr().modify(|w| w.set_jadstart(true));
}

/// From deep sleep to a calibrated converter (RM0440, 21.4.6 and 21.4.8).
fn wake_and_calibrate(adc: Adc) {
    adc.cr().write(|w| w.set_advregen(true));
    // 20 us for the regulator.
    cortex_m::asm::delay(20 * 168);
    adc.cr().write(|w| {
        w.set_advregen(true);
        w.set_adcaldif(Adcaldif::SINGLE_ENDED);
        w.set_adcal(true);
    });
    while adc.cr().read().adcal() {}
    // The converter may be enabled four of its cycles later.
    cortex_m::asm::delay(32);
}
