//! Constant configuration registers of the STM32G474, with masks of the checked bits.

use crate::board::registers::{ALL, CLOCK_TIMER, DRIVER_TIMER, PORT, Registers};

/// State without what hardware clears.
const CONVERTER_STATE: u32 = 0x3000_0001;
/// Configuration, sampling times, sequence.
const CONVERTER: &[u32] = &[0x0C, 0x14, 0x18, 0x4C];

/// The registers.
pub const REGISTERS: &[Registers] = &[
    // RCC: oscillators without their ready flags, PLL, clocks, enabled peripherals.
    (0x4002_1000, &[0x00], 0x010D_0100),
    (0x4002_1000, &[0x0C, 0x08, 0x4C, 0x58, 0x60, 0x88], ALL),
    // Boost mode.
    (0x4000_7000, &[0x80], ALL),
    // Wait states and caches.
    (0x4002_2000, &[0x00], ALL),
    // A lockup of the core switches the outputs off.
    (0x4001_0000, &[0x18], ALL),
    // GPIOA to GPIOC.
    (0x4800_0000, PORT, ALL),
    (0x4800_0400, PORT, ALL),
    (0x4800_0800, PORT, ALL),
    // TIM1 and TIM2.
    (0x4001_2C00, DRIVER_TIMER, ALL),
    (0x4000_0000, CLOCK_TIMER, ALL),
    // TIM16: control, capture, input.
    (0x4001_4400, &[0x00, 0x18, 0x20, 0x5C], ALL),
    // ADC1 to ADC3, and what they have in common.
    (0x5000_0000, &[0x08], CONVERTER_STATE),
    (0x5000_0000, CONVERTER, ALL),
    (0x5000_0100, &[0x08], CONVERTER_STATE),
    (0x5000_0100, CONVERTER, ALL),
    (0x5000_0400, &[0x08], CONVERTER_STATE),
    (0x5000_0400, CONVERTER, ALL),
    (0x5000_0300, &[0x08], ALL),
    (0x5000_0700, &[0x08], ALL),
    // CAN: configuration without the bits of initialisation, bit timing, filter.
    (0x4000_6400, &[0x18], 0x0000_FFFC),
    (0x4000_6400, &[0x1C, 0x80], ALL),
    // Debug freezes.
    (0xE004_2000, &[0x08, 0x10], ALL),
];
