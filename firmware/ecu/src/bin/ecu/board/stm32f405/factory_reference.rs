//! The internal reference, as measured by the manufacturer.

/// Address of the manufacturer's code of the internal reference (data sheet, table of internal reference calibration).
pub const FACTORY_REFERENCE: usize = 0x1FFF_7A2A;
/// Voltage of the converters' reference at that time, mV.
pub const FACTORY_REFERENCE_MV: u32 = 3_300;
