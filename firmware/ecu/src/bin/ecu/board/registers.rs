//! Registers of peripherals that both parts have, for the check of their configuration.

/// Registers of a peripheral that are written at the start only: its address, their offsets, and the checked bits.
pub type Registers = (u32, &'static [u32], u32);

/// All bits.
pub const ALL: u32 = u32::MAX;
/// A port: mode, type, speed, pulls, functions.
pub const PORT: &[u32] = &[0x00, 0x04, 0x08, 0x0C, 0x20, 0x24];
/// The timer of the drivers: control, modes, outputs, prescaler, period, repetition, break.
pub const DRIVER_TIMER: &[u32] = &[0x00, 0x04, 0x18, 0x20, 0x28, 0x2C, 0x30, 0x44];
/// The timer of the clock: control and prescaler.
pub const CLOCK_TIMER: &[u32] = &[0x00, 0x28];
