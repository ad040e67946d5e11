//! Constant configuration registers of the STM32F405, with masks of the checked bits.

/// All bits.
const ALL: u32 = u32::MAX;

/// Address and mask.
pub const REGISTERS: &[(u32, u32)] = &[
    // RCC: oscillators without their ready flags, PLL, clocks, enabled peripherals.
    (0x4002_3800, 0x010D_0001),
    (0x4002_3804, ALL),
    (0x4002_3808, ALL),
    (0x4002_3830, ALL),
    (0x4002_3840, ALL),
    (0x4002_3844, ALL),
    // Wait states and caches.
    (0x4002_3C00, ALL),
    // GPIOA: mode, type, speed, pulls, functions.
    (0x4002_0000, ALL),
    (0x4002_0004, ALL),
    (0x4002_0008, ALL),
    (0x4002_000C, ALL),
    (0x4002_0020, ALL),
    (0x4002_0024, ALL),
    // GPIOB: mode, type, speed, pulls, functions.
    (0x4002_0400, ALL),
    (0x4002_0404, ALL),
    (0x4002_0408, ALL),
    (0x4002_040C, ALL),
    (0x4002_0420, ALL),
    (0x4002_0424, ALL),
    // GPIOC: mode, type, speed, pulls, functions.
    (0x4002_0800, ALL),
    (0x4002_0804, ALL),
    (0x4002_0808, ALL),
    (0x4002_080C, ALL),
    (0x4002_0820, ALL),
    (0x4002_0824, ALL),
    // TIM1: control, modes, outputs, prescaler, period, repetition, break.
    (0x4001_0000, ALL),
    (0x4001_0004, ALL),
    (0x4001_0018, ALL),
    (0x4001_0020, ALL),
    (0x4001_0028, ALL),
    (0x4001_002C, ALL),
    (0x4001_0030, ALL),
    (0x4001_0044, ALL),
    // TIM2: control and prescaler.
    (0x4000_0000, ALL),
    (0x4000_0028, ALL),
    // TIM5: control, capture, input.
    (0x4000_0C00, ALL),
    (0x4000_0C1C, ALL),
    (0x4000_0C20, ALL),
    (0x4000_0C50, ALL),
    // ADC1 to ADC3: control without the start bit of regular conversions, sampling times, injected sequence, length of the
    // regular one.
    (0x4001_2004, ALL),
    (0x4001_2008, ALL),
    (0x4001_200C, ALL),
    (0x4001_2010, ALL),
    (0x4001_202C, ALL),
    (0x4001_2038, ALL),
    (0x4001_2104, ALL),
    (0x4001_2108, !(1 << 30)),
    (0x4001_210C, ALL),
    (0x4001_2110, ALL),
    (0x4001_212C, ALL),
    (0x4001_2138, ALL),
    (0x4001_2204, ALL),
    (0x4001_2208, ALL),
    (0x4001_220C, ALL),
    (0x4001_2210, ALL),
    (0x4001_222C, ALL),
    (0x4001_2238, ALL),
    (0x4001_2304, ALL),
    // CAN: master control without the request for initialisation, bit timing, filter.
    (0x4000_6400, 0x0000_00FC),
    (0x4000_641C, ALL),
    (0x4000_6600, ALL),
    (0x4000_661C, ALL),
    // Debug freezes.
    (0xE004_2008, ALL),
    (0xE004_200C, ALL),
];
