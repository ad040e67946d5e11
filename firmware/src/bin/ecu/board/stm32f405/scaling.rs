//! The scaling of the board with the STM32F405.

use hitch_firmware::control::units::{MilliAmp, MilliVolt, PerMille};
use hitch_firmware::ecu::{AdcCode, BoardScaling};

/// Twelve bits over a reference of 3.3 V.
pub const SCALING: BoardScaling = BoardScaling {
    // 168 MHz, counted up and down at 16 kHz.
    pwm_steps: 5_250,
    // A shunt and its amplifier bring 5 A to 3.3 V.
    current: MilliAmp(5_000),
    // A divider of 7.448; 6 mV a code.
    supply: MilliVolt(24_576),
    // Dividers that bring 5 V to 3.3 V.
    signal: MilliVolt(5_000),
    // A divider of 2.
    sensor_supply: MilliVolt(6_600),
    // A band gap of 1.21 V +-2.5 % (DS8626, VREFINT).
    reference: AdcCode::new(1_502),
    // 0.25 to 4.75 V of 5 V: the sensors give 0.5 to 4.5 V.
    wire_min: PerMille(50),
    wire_max: PerMille(950),
    // On PA5.
    second_track: true,
};
