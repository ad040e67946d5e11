//! Three converters, each with an injected sequence that TIM1 starts.
//!
//! The coils' currents come first in theirs: they are what has to be sampled in the middle of a pulse. Which channels
//! the signals are, and how a converter is set up and asked, is the part's.

use hitch_firmware::ecu::{AdcCode, Samples};
use stm32_metapac::adc::Adc;
use stm32_metapac::{ADC1, ADC2, ADC3};

use super::part::converters as part;

/// The converters.
pub struct Converters(());

impl Converters {
    /// Switches them on and lets them wait for the timer.
    pub fn start() -> Self {
        part::start_pins_and_clocks();
        part::start_sequence(ADC1, &part::FIRST);
        part::start_sequence(ADC2, &part::SECOND);
        part::start_sequence(ADC3, &part::THIRD);
        Self(())
    }

    /// The samples of a millisecond, once they are all there.
    pub fn take(&mut self) -> Option<Samples> {
        let converters = [ADC1, ADC2, ADC3];
        if !converters.iter().all(|adc| part::is_done(*adc)) {
            return None;
        }
        converters.into_iter().for_each(part::clear);
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
            ..Samples::default()
        })
    }
}
