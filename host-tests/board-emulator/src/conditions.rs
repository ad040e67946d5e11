//! Surroundings of the part: oscillators, voltages, and circuits at its pins.

use std::collections::HashMap;

use super::layout::Layout;
use super::part::Pin;

/// Conditions that a scenario sets and may change at any time.
#[derive(Clone, Debug)]
pub struct Conditions {
    /// Time until the crystal oscillates, ns; `None` if it never does.
    pub crystal_start_ns: Option<f64>,
    /// Frequency of the crystal, Hz.
    pub crystal_hz: f64,
    /// Frequency of the internal oscillator, Hz.
    pub internal_hz: f64,
    /// Frequency of the low-speed oscillator, Hz.
    pub slow_clock_hz: f64,
    /// Voltage of the converters' reference, V.
    pub reference_v: f64,
    /// Voltage of the internal reference, V.
    pub internal_reference_v: f64,
    /// Voltages at analogue pins, V.
    pub volts: HashMap<Pin, f64>,
    /// Pins that are driven from outside.
    pub levels: HashMap<Pin, bool>,
    /// A word of RAM in which bit 9 is stuck at zero; set before the board is made.
    pub stuck_ram: Option<u32>,
    /// Inputs that are wired to outputs of the part: from, to.
    pub wires: Vec<(Pin, Pin)>,
}

impl Conditions {
    /// Everything as in the data sheet.
    #[must_use]
    pub fn typical(layout: Layout) -> Self {
        Self {
            crystal_start_ns: Some(2e6),
            crystal_hz: layout.crystal_hz(),
            internal_hz: 16e6,
            slow_clock_hz: 32e3,
            reference_v: 3.3,
            internal_reference_v: layout.part().internal_reference_v(),
            volts: HashMap::new(),
            levels: HashMap::new(),
            stuck_ram: None,
            wires: Vec::new(),
        }
    }
}
