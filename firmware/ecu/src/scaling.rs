//! Scaling of a board: converter codes and PWM timer.

use hitch_quantities::calibration::fitted::Fitted;
use hitch_quantities::units::{MilliAmp, MilliVolt, PerMille};

use super::adc_code::AdcCode;

/// The scaling of a board. The full scales are quantities that give a code of 4096 with the nominal reference.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BoardScaling {
    /// Compare value for full duty; at most 42 000.
    pub pwm_steps: u16,
    /// Full scale of the coils' currents: shunt and amplifier.
    pub current: MilliAmp,
    /// Full scale of the supply: its divider.
    pub supply: MilliVolt,
    /// Full scale of the ratiometric sensors' signals: their dividers.
    pub signal: MilliVolt,
    /// Full scale of the sensor supply: its divider.
    pub sensor_supply: MilliVolt,
    /// Code of the internal band gap with the nominal reference.
    pub reference: AdcCode,
    /// Lowest fraction of the sensor supply in a healthy ratiometric signal: below it a wire is broken or shorted.
    pub wire_min: PerMille,
    /// Highest fraction.
    pub wire_max: PerMille,
    /// What the factory calibration monitors.
    pub fitted: Fitted,
}

impl BoardScaling {
    /// The board with a typical STM32F405 and one track of the rocker-angle sensor, and
    /// two contacts in each external button: twelve bits over a reference of 3.3 V.
    pub const NOMINAL: Self = Self {
        // 168 MHz, centre-aligned at 16 kHz.
        pwm_steps: 5_250,
        // Shunt and amplifier: 5 A at 3.3 V.
        current: MilliAmp(5_000),
        // Divider of 7.448; 6 mV per code.
        supply: MilliVolt(24_576),
        // Dividers: 5 V at 3.3 V.
        signal: MilliVolt(5_000),
        // A divider of 2.
        sensor_supply: MilliVolt(6_600),
        // A band gap of 1.21 V +-2.5 % (DS8626, VREFINT).
        reference: AdcCode::new(1_502),
        // 0.25 to 4.75 V of 5 V: the sensor range is 0.5 to 4.5 V.
        wire_min: PerMille(50),
        wire_max: PerMille(950),
        fitted: Fitted {
            second_track: false,
            second_contact: true,
        },
    };
}
