//! Three converters, each with an injected sequence triggered by TIM1, and regular conversions of the second one.
//!
//! The coil currents are first in their sequences, because they have to be sampled in the middle of a pulse. The slow
//! channels, those of draft and depth, are converted one after the other between two triggers, each started by the program
//! once the one before has ended: the first one when the codes of a millisecond are taken, the others while the program
//! waits for the next ones. An injected sequence has priority over a regular conversion. Channels, initialisation and flags
//! depend on the part.

use hitch_ecu::{AdcCode, Samples};
use stm32_metapac::adc::Adc;
use stm32_metapac::{ADC1, ADC2, ADC3};

use super::part::converters as part;

/// The converter of the slow channels.
const SLOW: Adc = ADC2;

/// The converters.
pub struct Converters {
    codes: [AdcCode; Samples::CHANNELS],
    /// Place of the slow channel that is being converted; their number if there is none.
    converting: usize,
}

impl Converters {
    /// Switches them on; they wait for the trigger.
    pub fn start() -> Self {
        part::start_pins_and_clocks();
        for (adc, sequence) in [ADC1, ADC2, ADC3].into_iter().zip(&part::SEQUENCES) {
            let slow = if adc == SLOW { &part::SLOW[..] } else { &[] };
            part::start_sequence(adc, sequence, slow);
        }
        Self {
            codes: [AdcCode::default(); Samples::CHANNELS],
            converting: part::SLOW.len(),
        }
    }

    /// Takes the code of a slow channel, once its conversion has ended, and starts the next one.
    pub fn listen(&mut self) {
        let Some(&(_, signal)) = part::SLOW.get(self.converting) else {
            return;
        };
        if let Some(code) = part::regular_code(SLOW) {
            self.codes[signal as usize] = AdcCode::new(code);
            self.converting = self.converting.saturating_add(1);
            self.convert();
        }
    }

    /// The samples of a millisecond, once they are complete. A slow channel whose conversion has not ended has no code of an
    /// earlier millisecond, but that of a broken wire.
    pub fn take(&mut self) -> Option<Samples> {
        let converters = [ADC1, ADC2, ADC3];
        if !converters.iter().all(|adc| part::is_done(*adc)) {
            return None;
        }
        self.listen();
        converters.into_iter().for_each(part::clear);
        for (adc, sequence) in converters.into_iter().zip(&part::SEQUENCES) {
            for (index, &(_, signal)) in sequence.iter().enumerate() {
                self.codes[signal as usize] = AdcCode::new(adc.jdr(index).read().jdata());
            }
        }
        let samples = Samples::from_codes(self.codes);
        for &(_, signal) in &part::SLOW {
            self.codes[signal as usize] = AdcCode::default();
        }
        self.converting = 0;
        self.convert();
        Some(samples)
    }

    /// Starts the conversion of a slow channel. If it can't be started, the rest of the millisecond has no codes.
    fn convert(&mut self) {
        let Some(&(channel, _)) = part::SLOW.get(self.converting) else {
            return;
        };
        if !part::start_regular(SLOW, channel) {
            self.converting = part::SLOW.len();
        }
    }
}
