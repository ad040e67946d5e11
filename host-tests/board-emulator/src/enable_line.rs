//! Pins of the line that enables the coil drivers.

use super::part::{Pin, Port};

/// Output of the enable line.
pub const ENABLE: Pin = Pin::new(Port::B, 10);

/// Input that reads the enable line back at the drivers.
pub const ENABLE_READ_BACK: Pin = Pin::new(Port::B, 11);
