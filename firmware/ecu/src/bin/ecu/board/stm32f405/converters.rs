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

/// The slow channels of ADC2 in the order of their conversions.
pub const SLOW: [(u8, Signal); 5] = [
    (6, Signal::LeftPin),       // PA6
    (7, Signal::RightPin),      // PA7
    (9, Signal::DepthSensor),   // PB1
    (14, Signal::MixDial),      // PC4
    (15, Signal::SetPointDial), // PC5
];

/// The flags of the status register, each cleared by writing zero (RM0090, 13.13.1).
const FLAGS: u32 = 0x3F;
/// The end of an injected sequence.
const JEOC: u32 = 1 << 2;

/// VREFINT, on ADC1 only.
const REFERENCE: u8 = 17;

/// Sets the pins to analogue mode, and the clock of the converters.
pub fn start_pins_and_clocks() {
    for pin in 0..=3 {
        pins::analog(GPIOA, pin);
        pins::analog(GPIOC, pin);
    }
    for pin in 4..=7 {
        pins::analog(GPIOA, pin);
    }
    for (port, pin) in [(GPIOB, 0), (GPIOB, 1), (GPIOC, 4), (GPIOC, 5)] {
        pins::analog(port, pin);
    }
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
    // Writing one leaves a flag: reading it before could lose a regular conversion that ends in between.
    adc.sr().write(|w| w.0 = FLAGS & !JEOC);
}

/// Starts a regular conversion of one channel; true if it has started (RM0090, 13.3.3). One that has not ended is dropped, since
/// writing the sequence begins anew. Hardware clears the start bit.
pub fn start_regular(adc: Adc, channel: u8) -> bool {
    adc.sqr3().write(|w| w.set_sq(0, channel));
    // Reading clears the flag of a conversion that has ended meanwhile.
    let _ = adc.dr().read();
    adc.cr2().modify(|w| w.set_swstart(true));
    true
}

/// The code of the regular conversion, once, when it has ended. Reading it clears the flag.
pub fn regular_code(adc: Adc) -> Option<u16> {
    adc.sr().read().eoc().then(|| adc.dr().read().data())
}

/// Prepares the injected sequence and the regular conversions of a converter. Four channels take 4 * (84 + 12) / 21 MHz = 18 us; the internal reference has to be sampled for 10 us, and takes 23 us.
pub fn start_sequence(adc: Adc, sequence: &[(u8, Signal); 4], slow: &[(u8, Signal)]) {
    for &(channel, _) in sequence.iter().chain(slow) {
        let time = match channel {
            REFERENCE => SampleTime::CYCLES480,
            _ => SampleTime::CYCLES84,
        };
        let channel = usize::from(channel);
        match channel.checked_sub(10) {
            // The last channel is 18.
            Some(high) => adc.smpr1().modify(|w| w.set_smp(high % 9, time)),
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
