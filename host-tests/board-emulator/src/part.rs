//! The two parts: memories, peripherals, oscillators and pins.

use std::fmt;

/// A part that there is a board for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// STM32F405RG (RM0090).
    Stm32f405,
    /// STM32G474RE (RM0440).
    Stm32g474,
}

/// Places of the peripherals that the image uses.
#[derive(Clone, Copy, Debug)]
pub struct Addresses {
    /// Reset and clock control.
    pub rcc: u32,
    /// Flash interface.
    pub flash: u32,
    /// GPIOA; B and C follow, 0x400 apart.
    pub gpio: u32,
    /// Timer of the pulse-width outputs.
    pub tim1: u32,
    /// Timer that measures the low-speed oscillator: TIM5 or TIM16.
    pub slow_clock_timer: u32,
    /// ADC1, ADC2 and ADC3.
    pub adc: [u32; 3],
    /// Common registers of ADC1 and 2, and of ADC3.
    pub adc_common: [u32; 2],
    /// The part's unique number.
    pub unique_id: u32,
}

/// TIM2: the free-running clock.
pub const TIM2: u32 = 0x4000_0000;
/// Independent watchdog.
pub const IWDG: u32 = 0x4000_3000;
/// CAN controller.
pub const CAN: u32 = 0x4000_6400;
/// Message memory of the FDCAN controller.
pub const FDCAN_RAM: u32 = 0x4000_A400;
/// Power control.
pub const PWR: u32 = 0x4000_7000;
/// Debug support.
pub const DBGMCU: u32 = 0xE004_2000;
/// First address of flash.
pub const FLASH: u32 = 0x0800_0000;
/// First address of RAM.
pub const RAM: u32 = 0x2000_0000;
/// Bytes of RAM.
pub const RAM_BYTES: u32 = 128 * 1024;

impl Part {
    /// Where the image keeps its data in flash, the log of faults and then the calibration: first address and bytes.
    #[must_use]
    pub const fn data(self) -> (u32, u32) {
        match self {
            Self::Stm32f405 => (0x0808_0000, 512 * 1024),
            Self::Stm32g474 => (0x0807_D000, 12 * 1024),
        }
    }

    /// Bytes of the log of faults: two sectors or pages.
    #[must_use]
    pub const fn log_bytes(self) -> u32 {
        2 * self.erase_bytes()
    }

    /// Bytes of a sector or page of the data.
    #[must_use]
    pub const fn erase_bytes(self) -> u32 {
        match self {
            Self::Stm32f405 => 128 * 1024,
            Self::Stm32g474 => 2 * 1024,
        }
    }

    /// Frequencies that the low-speed oscillator may have, Hz (data sheets).
    #[must_use]
    pub const fn slow_clock_hz(self) -> [f64; 2] {
        match self {
            Self::Stm32f405 => [17e3, 47e3],
            Self::Stm32g474 => [29.5e3, 34e3],
        }
    }

    /// Frequencies that the internal oscillator may have, Hz, over temperature and supply (data sheets).
    #[must_use]
    pub const fn internal_hz(self) -> [f64; 2] {
        match self {
            // -8 to 4.5 %.
            Self::Stm32f405 => [14.72e6, 16.72e6],
            // 15.88 to 16.08 MHz, then -2.1 to 1.55 %.
            Self::Stm32g474 => [15.546e6, 16.329e6],
        }
    }

    /// Voltage of the internal reference, V.
    #[must_use]
    pub const fn internal_reference_v(self) -> f64 {
        match self {
            Self::Stm32f405 => 1.21,
            Self::Stm32g474 => 1.212,
        }
    }

    /// Places of the peripherals.
    #[must_use]
    pub const fn addresses(self) -> Addresses {
        match self {
            Self::Stm32f405 => Addresses {
                rcc: 0x4002_3800,
                flash: 0x4002_3C00,
                gpio: 0x4002_0000,
                tim1: 0x4001_0000,
                slow_clock_timer: 0x4000_0C00,
                adc: [0x4001_2000, 0x4001_2100, 0x4001_2200],
                adc_common: [0x4001_2300, 0x4001_2300],
                unique_id: 0x1FFF_7A10,
            },
            Self::Stm32g474 => Addresses {
                rcc: 0x4002_1000,
                flash: 0x4002_2000,
                gpio: 0x4800_0000,
                tim1: 0x4001_2C00,
                slow_clock_timer: 0x4001_4400,
                adc: [0x5000_0000, 0x5000_0100, 0x5000_0400],
                adc_common: [0x5000_0300, 0x5000_0700],
                unique_id: 0x1FFF_7590,
            },
        }
    }

    /// The pin of a converter's channel, by converter 0 to 2; `None` for channels without one.
    #[must_use]
    pub const fn analog_pin(self, converter: usize, channel: u32) -> Option<Pin> {
        let pin = match (self, converter, channel) {
            (Self::Stm32f405, 0..=2, 0..=3) => Pin::new(Port::A, channel),
            (Self::Stm32f405, 0 | 1, 4..=7) => Pin::new(Port::A, channel),
            (Self::Stm32f405, 0 | 1, 8 | 9) => Pin::new(Port::B, channel - 8),
            (Self::Stm32f405, 0..=2, 10..=13) => Pin::new(Port::C, channel - 10),
            (Self::Stm32f405, 0 | 1, 14 | 15) => Pin::new(Port::C, channel - 10),
            (Self::Stm32g474, 0, 1..=4) => Pin::new(Port::A, channel - 1),
            (Self::Stm32g474, 1, 1 | 2) => Pin::new(Port::A, channel - 1),
            (Self::Stm32g474, 1, 3..=5) => [
                Pin::new(Port::A, 6),
                Pin::new(Port::A, 7),
                Pin::new(Port::C, 4),
            ][channel as usize - 3],
            (Self::Stm32g474, 1, 11) => Pin::new(Port::C, 5),
            (Self::Stm32g474, 1, 13) => Pin::new(Port::A, 5),
            (Self::Stm32g474, 1, 15) => Pin::new(Port::B, 15),
            (Self::Stm32g474, 1, 17) => Pin::new(Port::A, 4),
            (Self::Stm32g474, 0 | 1, 6..=9) => Pin::new(Port::C, channel - 6),
            (Self::Stm32g474, 0, 15) => Pin::new(Port::B, 0),
            (Self::Stm32g474, 2, 1) => Pin::new(Port::B, 1),
            (Self::Stm32g474, 2, 12) => Pin::new(Port::B, 0),
            (Self::Stm32g474, 2, 5) => Pin::new(Port::B, 13),
            _ => return None,
        };
        Some(pin)
    }

    /// True if a converter's channel is the internal reference.
    #[must_use]
    pub const fn is_internal_reference(self, converter: usize, channel: u32) -> bool {
        matches!(
            (self, converter, channel),
            (Self::Stm32f405, 0, 17) | (Self::Stm32g474, 0 | 2, 18)
        )
    }
}

/// A port of sixteen pins, by its place behind GPIOA.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Port {
    /// GPIOA.
    A,
    /// GPIOB.
    B,
    /// GPIOC.
    C,
}

/// A pin.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Pin {
    /// Its port.
    pub port: Port,
    /// Its number, 0 to 15.
    pub number: u32,
}

impl Pin {
    /// A pin of a port.
    #[must_use]
    pub const fn new(port: Port, number: u32) -> Self {
        Self { port, number }
    }
}

impl fmt::Display for Pin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "P{:?}{}", self.port, self.number)
    }
}
