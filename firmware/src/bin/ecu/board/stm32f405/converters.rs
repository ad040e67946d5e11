//! Which channels the signals are on the STM32F405, and how its converters are set up and asked.

use stm32_metapac::adc::Adc;
use stm32_metapac::adc::vals::{Exten, SampleTime};
use stm32_metapac::adccommon::vals::Adcpre;
use stm32_metapac::{ADC123_COMMON, GPIOA, GPIOB, GPIOC};

use crate::board::pins;

/// TIM1_TRGO (RM0090, table of `JEXTSEL`).
const TIM1_TRGO: u8 = 1;
/// Lift current PA2, angle PA0, upper-limit dial PA3, supply PB0.
pub const FIRST: [u8; 4] = [2, 0, 3, 8];
/// Lowering current PC0, lever PA1, lowering dial PC1, cylinder pressure PC2.
pub const SECOND: [u8; 4] = [10, 1, 11, 12];
/// Pump pressure PC3.
pub const THIRD: [u8; 1] = [13];

/// Makes the pins analogue and sets the converters' clock.
pub fn start_pins_and_clocks() {
    for pin in 0..=3 {
        pins::analog(GPIOA, pin);
        pins::analog(GPIOC, pin);
    }
    pins::analog(GPIOB, 0);
    // 84 MHz / 4 = 21 MHz, of 36 MHz allowed.
    ADC123_COMMON.ccr().modify(|w| w.set_adcpre(Adcpre::DIV4));
}

/// True once a sequence has run.
pub fn is_done(adc: Adc) -> bool {
    adc.sr().read().jeoc()
}

/// Makes ready for the next one.
pub fn clear(adc: Adc) {
    // Writing zero clears; the other flags don't mind.
    adc.sr().modify(|w| w.set_jeoc(false));
}

/// Four channels take 4 * (84 + 12) / 21 MHz = 18 us.
pub fn start_sequence(adc: Adc, channels: &[u8]) {
    for &channel in channels {
        let channel = usize::from(channel);
        match channel.checked_sub(10) {
            Some(high) => adc
                .smpr1()
                .modify(|w| w.set_smp(high, SampleTime::CYCLES84)),
            None => adc
                .smpr2()
                .modify(|w| w.set_smp(channel, SampleTime::CYCLES84)),
        }
    }
    adc.jsqr().write(|w| {
        w.set_jl(channels.len() as u8 - 1);
        // A sequence shorter than four ends at the fourth place (RM0090, 13.13.12).
        let first = 4 - channels.len();
        for (index, &channel) in channels.iter().enumerate() {
            w.set_jsq(first + index, channel);
        }
    });
    adc.cr1().modify(|w| w.set_scan(true));
    adc.cr2().write(|w| {
        w.set_adon(true);
        w.set_jextsel(TIM1_TRGO);
        w.set_jexten(Exten::RISING_EDGE);
    });
}
