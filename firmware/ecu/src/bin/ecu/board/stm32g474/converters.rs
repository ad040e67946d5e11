//! Converter channels of the STM32G474, and the configuration of its converters.

use embedded_hal::delay::DelayNs;
use hitch_ecu::Signal;
use stm32_metapac::adc::Adc;
use stm32_metapac::adc::vals::{Adcaldif, Exten, SampleTime};
use stm32_metapac::adccommon::vals::Ckmode;
use stm32_metapac::{ADC12_COMMON, ADC345_COMMON};

use super::board_data::ANALOG_PINS;
pub use super::board_data::{SEQUENCES, SLOW};
use super::delay::CycleDelay;
use super::factory_reference::REFERENCE;
use crate::board::pins;

/// TIM1_TRGO for ADC1 and 2 and for ADC3 (RM0440, tables of `JEXTSEL`).
const TIM1_TRGO: u8 = 0;
/// Sets the pins to analogue mode, and the clock of the converters.
pub fn start_pins_and_clocks() {
    for (port, numbers) in ANALOG_PINS {
        numbers.iter().for_each(|&pin| pins::analog(port, pin));
    }
    // 168 MHz / 4 = 42 MHz, of 60 MHz allowed.
    for common in [ADC12_COMMON, ADC345_COMMON] {
        common.ccr().modify(|w| {
            w.set_ckmode(Ckmode::SYNC_DIV4);
            w.set_vrefen(true);
        });
    }
}

/// Whether a sequence has ended.
pub fn is_done(adc: Adc) -> bool {
    adc.isr().read().jeos()
}

/// Prepares the next sequence.
pub fn clear(adc: Adc) {
    // Writing one clears.
    adc.isr().write(|w| w.set_jeos(true));
}

/// Starts a regular conversion of one channel; true if it has started (RM0440, 21.4.15). The sequence must not be changed while
/// one runs. Writing zero leaves the other bits, which enable the converter and arm its trigger.
pub fn start_regular(adc: Adc, channel: u8) -> bool {
    if adc.cr().read().adstart() {
        return false;
    }
    // Reading clears the end of a conversion that nobody has waited for.
    let _ = adc.dr().read();
    adc.sqr1().write(|w| w.set_sq(0, channel));
    adc.cr().write(|w| {
        w.set_advregen(true);
        w.set_adstart(true);
    });
    true
}

/// The code of the regular conversion, once, when it has ended. Reading it clears the flag; the start bit is cleared after it.
pub fn regular_code(adc: Adc) -> Option<u16> {
    let has_ended = adc.isr().read().eoc() && !adc.cr().read().adstart();
    has_ended.then(|| adc.dr().read().rdata())
}

/// Prepares the injected sequence and the regular conversions of a converter. Four channels take 4 * (92.5 + 12.5) / 42 MHz = 10 us; the internal reference has to be sampled for 4 us, and takes
/// 6 us.
pub fn start_sequence(adc: Adc, sequence: &[(u8, Signal); 4], slow: &[(u8, Signal)]) {
    wake_and_calibrate(adc);
    for &(channel, _) in sequence.iter().chain(slow) {
        let time = match channel {
            REFERENCE => SampleTime::CYCLES247_5,
            _ => SampleTime::CYCLES92_5,
        };
        let channel = usize::from(channel);
        match channel.checked_sub(10) {
            // The last channel is 18.
            Some(high) => adc.smpr2().modify(|w| w.set_smp(high % 9, time)),
            None => adc.smpr().modify(|w| w.set_smp(channel, time)),
        }
    }
    adc.isr().write(|w| w.set_adrdy(true));
    adc.cr().modify(|w| w.set_aden(true));
    while !adc.isr().read().adrdy() {}
    // Without the queue of contexts the sequence is kept after a run.
    adc.cfgr().modify(|w| w.set_jqdis(true));
    adc.jsqr().write(|w| {
        w.set_jl(3);
        w.set_jextsel(TIM1_TRGO);
        w.set_jexten(Exten::RISING_EDGE);
        for (index, &(channel, _)) in sequence.iter().enumerate() {
            w.set_jsq(index, channel);
        }
    });
    adc.cr().modify(|w| w.set_jadstart(true));
}

/// From deep sleep to a calibrated converter (RM0440, 21.4.6 and 21.4.8).
fn wake_and_calibrate(adc: Adc) {
    adc.cr().write(|w| w.set_advregen(true));
    // 20 us for the regulator.
    CycleDelay.delay_us(20);
    adc.cr().write(|w| {
        w.set_advregen(true);
        w.set_adcaldif(Adcaldif::SINGLE_ENDED);
        w.set_adcal(true);
    });
    while adc.cr().read().adcal() {}
    // The converter may be enabled four cycles later.
    cortex_m::asm::delay(32);
}
