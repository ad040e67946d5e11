//! Three converters, each with an injected sequence that TIM1 starts.
//!
//! The coils' currents come first in theirs: they are what has to be sampled in the middle of a pulse.

use hitch_firmware::ecu::{AdcCode, Samples};
use stm32_metapac::adc::Adc;
use stm32_metapac::adc::vals::{Exten, SampleTime};
use stm32_metapac::adccommon::vals::Adcpre;
use stm32_metapac::{ADC1, ADC2, ADC3, ADC123_COMMON, GPIOA, GPIOB, GPIOC};

use crate::board::pins;

/// TIM1_TRGO (RM0090, table of `JEXTSEL`).
const TIM1_TRGO: u8 = 1;
/// Lift current PA2, angle PA0, upper-limit dial PA3, supply PB0.
const FIRST: [u8; 4] = [2, 0, 3, 8];
/// Lowering current PC0, lever PA1, lowering dial PC1, cylinder pressure PC2.
const SECOND: [u8; 4] = [10, 1, 11, 12];
/// Pump pressure PC3.
const THIRD: [u8; 1] = [13];

/// The converters.
pub struct Converters(());

impl Converters {
    /// Switches them on and lets them wait for the timer.
    pub fn start() -> Self {
        for pin in 0..=3 {
            pins::analog(GPIOA, pin);
            pins::analog(GPIOC, pin);
        }
        pins::analog(GPIOB, 0);
        // 84 MHz / 4 = 21 MHz, of 36 MHz allowed.
        ADC123_COMMON.ccr().modify(|w| w.set_adcpre(Adcpre::DIV4));
        start_sequence(ADC1, &FIRST);
        start_sequence(ADC2, &SECOND);
        start_sequence(ADC3, &THIRD);
        Self(())
    }

    /// The samples of a millisecond, once they are all there.
    pub fn take(&mut self) -> Option<Samples> {
        if ![ADC1, ADC2, ADC3].iter().all(|adc| adc.sr().read().jeoc()) {
            return None;
        }
        for adc in [ADC1, ADC2, ADC3] {
            // Writing zero clears; the other flags don't mind.
            adc.sr().modify(|w| w.set_jeoc(false));
        }
        let code = |adc: Adc, index: usize| AdcCode::new(adc.jdr(index).read().jdata());
        Some(Samples {
            lift_current: code(ADC1, 0),
            rocker_angle: code(ADC1, 1),
            upper_limit: code(ADC1, 2),
            supply: code(ADC1, 3),
            lower_current: code(ADC2, 0),
            lever: code(ADC2, 1),
            lowering_dial: code(ADC2, 2),
            cylinder_pressure: code(ADC2, 3),
            pump_pressure: code(ADC3, 0),
        })
    }
}

/// Four channels take 4 * (84 + 12) / 21 MHz = 18 us.
fn start_sequence(adc: Adc, channels: &[u8]) {
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
