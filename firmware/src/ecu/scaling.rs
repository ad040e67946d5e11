//! What belongs to a board: how its converters' codes and its pulse-width timer are scaled.

use super::converter::AdcCode;
use crate::control::units::{MilliAmp, MilliVolt, PerMille};

/// The scaling of a board. The full scales are quantities that give a code of 4096 with the nominal reference.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BoardScaling {
    /// Compare value at which a coil's driver is on throughout; at most 42 000.
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
    /// Smallest share of the sensor supply in a healthy ratiometric signal: below it a wire is broken or shorted.
    pub wire_min: PerMille,
    /// Largest share.
    pub wire_max: PerMille,
    /// Whether the board's rocker-angle sensor has a second, inverted track: the factory's calibration then watches it.
    pub second_track: bool,
}
