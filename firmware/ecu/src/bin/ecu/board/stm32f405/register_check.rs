//! Constant configuration registers of the STM32F405, with masks of the checked bits.

use crate::board::registers::{ALL, CLOCK_TIMER, DRIVER_TIMER, PORT, Registers};

/// Control, sampling times, injected sequence, and length of the regular one.
const CONVERTER: &[u32] = &[0x04, 0x08, 0x0C, 0x10, 0x2C, 0x38];

/// The registers.
pub const REGISTERS: &[Registers] = &[
    // RCC: oscillators without their ready flags, PLL, clocks, enabled peripherals.
    (0x4002_3800, &[0x00], 0x010D_0001),
    (0x4002_3800, &[0x04, 0x08, 0x30, 0x40, 0x44], ALL),
    // Wait states and caches.
    (0x4002_3C00, &[0x00], ALL),
    // GPIOA to GPIOC.
    (0x4002_0000, PORT, ALL),
    (0x4002_0400, PORT, ALL),
    (0x4002_0800, PORT, ALL),
    // TIM1 and TIM2.
    (0x4001_0000, DRIVER_TIMER, ALL),
    (0x4000_0000, CLOCK_TIMER, ALL),
    // TIM5: control, capture, input.
    (0x4000_0C00, &[0x00, 0x1C, 0x20, 0x50], ALL),
    // ADC1 to ADC3; the second one without the start bit of regular conversions.
    (0x4001_2000, CONVERTER, ALL),
    (0x4001_2100, &[0x04], ALL),
    (0x4001_2100, &[0x08], !(1 << 30)),
    (0x4001_2100, &[0x0C, 0x10, 0x2C, 0x38], ALL),
    (0x4001_2200, CONVERTER, ALL),
    (0x4001_2300, &[0x04], ALL),
    // CAN: master control without the request for initialisation, bit timing, filter.
    (0x4000_6400, &[0x00], 0x0000_00FC),
    (0x4000_6400, &[0x1C, 0x200, 0x21C], ALL),
    // Debug freezes.
    (0xE004_2000, &[0x08, 0x0C], ALL),
];
