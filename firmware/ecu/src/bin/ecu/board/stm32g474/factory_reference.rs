//! The internal reference: its channel, and its value as measured by the manufacturer.

/// Address of the manufacturer's code of the internal reference (data sheet, table of internal reference calibration).
pub const FACTORY_REFERENCE: usize = 0x1FFF_75AA;
/// Voltage of the converters' reference at that time, mV.
pub const FACTORY_REFERENCE_MV: u32 = 3_000;

/// Channel of the internal reference, VREFINT, on ADC1 and ADC3.
pub const REFERENCE: u8 = 18;
