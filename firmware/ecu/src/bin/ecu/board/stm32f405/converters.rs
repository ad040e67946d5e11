//! Converter channels of the STM32F405, and the configuration of its converters.

use hitch_ecu::Signal;
use stm32_metapac::adc::Adc;
use stm32_metapac::adc::vals::{Exten, SampleTime};
use stm32_metapac::adccommon::vals::Adcpre;
use stm32_metapac::{ADC123_COMMON, GPIOA, GPIOB, GPIOC};

use crate::board::pins;

/// TIM1_TRGO (RM0090, table of `JEXTSEL`).
const TIM1_TRGO: u8 = 1;
/// The channels of the three sequences in the order of their ranks, with their signals.
pub const SEQUENCES: [[(u8, Signal); 4]; 3] = [
    [
        (2, Signal::LiftCurrent), // PA2
        (0, Signal::RockerAngle), // PA0
        (8, Signal::Supply),      // PB0
        (REFERENCE, Signal::Reference),
    ],
    [
        (10, Signal::LowerCurrent), // PC0
        (1, Signal::Lever),         // PA1
        (5, Signal::SecondAngle),   // PA5
        (4, Signal::SensorSupply),  // PA4
    ],
    [
        (13, Signal::PumpPressure),     // PC3
        (3, Signal::UpperLimit),        // PA3
        (11, Signal::LoweringDial),     // PC1
        (12, Signal::CylinderPressure), // PC2
    ],
];

/// VREFINT, on ADC1 only.
const REFERENCE: u8 = 17;

/// Sets the pins to analogue mode, and the clock of the converters.
pub fn start_pins_and_clocks() {
    for pin in 0..=3 {
        pins::analog(GPIOA, pin);
        pins::analog(GPIOC, pin);
    }
    pins::analog(GPIOA, 4);
    pins::analog(GPIOA, 5);
    pins::analog(GPIOB, 0);
    ADC123_COMMON.ccr().modify(|w| {
        // 84 MHz / 4 = 21 MHz, of 36 MHz allowed.
        w.set_adcpre(Adcpre::DIV4);
        w.set_tsvrefe(true);
    });
}

/// Whether a sequence has ended.
pub fn is_done(adc: Adc) -> bool {
    adc.sr().read().jeoc()
}

/// Prepares the next sequence.
pub fn clear(adc: Adc) {
    // Writing zero clears a flag; the other flags are not affected.
    adc.sr().modify(|w| w.set_jeoc(false));
}

/// Four channels take 4 * (84 + 12) / 21 MHz = 18 us; the internal reference has to be sampled for 10 us, and takes 23 us.
pub fn start_sequence(adc: Adc, sequence: &[(u8, Signal); 4]) {
    for &(channel, _) in sequence {
        let time = match channel {
            REFERENCE => SampleTime::CYCLES480,
            _ => SampleTime::CYCLES84,
        };
        let channel = usize::from(channel);
        match channel.checked_sub(10) {
            Some(high) => adc.smpr1().modify(|w| w.set_smp(high, time)),
            None => adc.smpr2().modify(|w| w.set_smp(channel, time)),
        }
    }
    adc.jsqr().write(|w| {
        w.set_jl(3);
        for (index, &(channel, _)) in sequence.iter().enumerate() {
            w.set_jsq(index, channel);
        }
    });
    adc.cr1().modify(|w| w.set_scan(true));
    adc.cr2().write(|w| {
        w.set_adon(true);
        w.set_jextsel(TIM1_TRGO);
        w.set_jexten(Exten::RISING_EDGE);
    });
}
