//! Three converters, each with an injected sequence triggered by TIM1.
//!
//! The coil currents are first in their sequences, because they have to be sampled in the middle of a pulse. Channels,
//! initialisation and flags depend on the part.

use hitch_ecu::{AdcCode, Samples};
use stm32_metapac::{ADC1, ADC2, ADC3};

use super::part::converters as part;

/// The converters.
pub struct Converters(());

impl Converters {
    /// Switches them on; they wait for the trigger.
    pub fn start() -> Self {
        part::start_pins_and_clocks();
        for (adc, sequence) in [ADC1, ADC2, ADC3].into_iter().zip(&part::SEQUENCES) {
            part::start_sequence(adc, sequence);
        }
        Self(())
    }

    /// The samples of a millisecond, once they are complete.
    pub fn take(&mut self) -> Option<Samples> {
        let converters = [ADC1, ADC2, ADC3];
        if !converters.iter().all(|adc| part::is_done(*adc)) {
            return None;
        }
        converters.into_iter().for_each(part::clear);
        let mut codes = [AdcCode::default(); Samples::CHANNELS];
        for (adc, sequence) in converters.into_iter().zip(&part::SEQUENCES) {
            for (index, &(_, signal)) in sequence.iter().enumerate() {
                codes[signal as usize] = AdcCode::new(adc.jdr(index).read().jdata());
            }
        }
        Some(Samples::from_codes(codes))
    }
}
