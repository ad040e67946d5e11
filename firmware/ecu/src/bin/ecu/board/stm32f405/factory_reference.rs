//! The internal reference as the maker has measured it.

/// Where the maker has stored the code of the internal reference (data sheet, table of internal reference calibration).
pub const FACTORY_REFERENCE: usize = 0x1FFF_7A2A;
/// Voltage of the converters' reference at that time, mV.
pub const FACTORY_REFERENCE_MV: u32 = 3_300;
