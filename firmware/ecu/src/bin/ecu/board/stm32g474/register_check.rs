//! Constant configuration registers of the STM32G474, with masks of the checked bits.

/// All bits.
const ALL: u32 = u32::MAX;

/// Address and mask.
pub const REGISTERS: &[(u32, u32)] = &[
    // RCC: oscillators without their ready flags, PLL, clocks, enabled peripherals.
    (0x4002_1000, 0x010D_0100),
    (0x4002_100C, ALL),
    (0x4002_1008, ALL),
    (0x4002_104C, ALL),
    (0x4002_1058, ALL),
    (0x4002_1060, ALL),
    (0x4002_1088, ALL),
    // Boost mode.
    (0x4000_7080, ALL),
    // Wait states and caches.
    (0x4002_2000, ALL),
    // A lockup of the core switches the outputs off.
    (0x4001_0018, ALL),
    // GPIOA: mode, type, speed, pulls, functions.
    (0x4800_0000, ALL),
    (0x4800_0004, ALL),
    (0x4800_0008, ALL),
    (0x4800_000C, ALL),
    (0x4800_0020, ALL),
    (0x4800_0024, ALL),
    // GPIOB: mode, type, speed, pulls, functions.
    (0x4800_0400, ALL),
    (0x4800_0404, ALL),
    (0x4800_0408, ALL),
    (0x4800_040C, ALL),
    (0x4800_0420, ALL),
    (0x4800_0424, ALL),
    // GPIOC: mode, type, speed, pulls, functions.
    (0x4800_0800, ALL),
    (0x4800_0804, ALL),
    (0x4800_0808, ALL),
    (0x4800_080C, ALL),
    (0x4800_0820, ALL),
    (0x4800_0824, ALL),
    // TIM1: control, modes, outputs, prescaler, period, repetition, break.
    (0x4001_2C00, ALL),
    (0x4001_2C04, ALL),
    (0x4001_2C18, ALL),
    (0x4001_2C20, ALL),
    (0x4001_2C28, ALL),
    (0x4001_2C2C, ALL),
    (0x4001_2C30, ALL),
    (0x4001_2C44, ALL),
    // TIM2: control and prescaler.
    (0x4000_0000, ALL),
    (0x4000_0028, ALL),
    // TIM16: control, capture, input.
    (0x4001_4400, ALL),
    (0x4001_4418, ALL),
    (0x4001_4420, ALL),
    (0x4001_445C, ALL),
    // ADC1 to ADC3: state without what hardware clears, configuration, sampling times, sequence.
    (0x5000_0008, 0x3000_0001),
    (0x5000_000C, ALL),
    (0x5000_0014, ALL),
    (0x5000_0018, ALL),
    (0x5000_004C, ALL),
    (0x5000_0108, 0x3000_0001),
    (0x5000_010C, ALL),
    (0x5000_0114, ALL),
    (0x5000_0118, ALL),
    (0x5000_014C, ALL),
    (0x5000_0408, 0x3000_0001),
    (0x5000_040C, ALL),
    (0x5000_0414, ALL),
    (0x5000_0418, ALL),
    (0x5000_044C, ALL),
    (0x5000_0308, ALL),
    (0x5000_0708, ALL),
    // CAN: configuration without the bits of initialisation, bit timing, filter.
    (0x4000_6418, 0x0000_FFFC),
    (0x4000_641C, ALL),
    (0x4000_6480, ALL),
    // Debug freezes.
    (0xE004_2008, ALL),
    (0xE004_2010, ALL),
];
