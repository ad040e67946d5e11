//! The boards: part, crystal, pins and dividers.

use std::fmt;
use std::str::FromStr;

use anyhow::{Error, bail};
use hitch_ecu::{BoardScaling, Panel, Samples};
use hitch_quantities::units::MilliVolt;

use super::part::{Part, Pin, Port};

/// A board that there is an image for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// The ECU's with an STM32F405RG.
    Stm32f405,
    /// The ECU's with an STM32G474RE.
    Stm32g474,
    /// ST's NUCLEO-G474RE (UM2505).
    NucleoG474re,
}

impl Layout {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Stm32f405, Self::Stm32g474, Self::NucleoG474re];

    /// Name as in the images' names.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Stm32f405 => "stm32f405",
            Self::Stm32g474 => "stm32g474",
            Self::NucleoG474re => "nucleo-g474re",
        }
    }

    /// The part on it.
    #[must_use]
    pub const fn part(self) -> Part {
        match self {
            Self::Stm32f405 => Part::Stm32f405,
            Self::Stm32g474 | Self::NucleoG474re => Part::Stm32g474,
        }
    }

    /// Its crystal, Hz.
    #[must_use]
    pub const fn crystal_hz(self) -> f64 {
        match self {
            Self::Stm32f405 | Self::Stm32g474 => 8e6,
            Self::NucleoG474re => 24e6,
        }
    }

    /// The inputs from converters, in the order of [`Samples::codes`]; `None` for the internal reference.
    #[must_use]
    pub const fn sample_pins(self) -> [Option<Pin>; Samples::CHANNELS] {
        const fn a(number: u32) -> Option<Pin> {
            Some(Pin::new(Port::A, number))
        }
        const fn b(number: u32) -> Option<Pin> {
            Some(Pin::new(Port::B, number))
        }
        const fn c(number: u32) -> Option<Pin> {
            Some(Pin::new(Port::C, number))
        }
        let (pump, sensor_supply, depth_sensor) = match self {
            Self::Stm32f405 => (c(3), a(4), b(1)),
            Self::Stm32g474 | Self::NucleoG474re => (b(1), b(13), b(15)),
        };
        let (upper_limit, lift_current) = match self {
            Self::Stm32f405 | Self::Stm32g474 => (a(3), a(2)),
            Self::NucleoG474re => (c(3), a(4)),
        };
        [
            a(0),
            a(1),
            upper_limit,
            c(1),
            lift_current,
            c(0),
            b(0),
            c(2),
            pump,
            a(5),
            sensor_supply,
            None,
            a(6),
            a(7),
            depth_sensor,
            c(4),
            c(5),
        ]
    }

    /// The pins of the contacts, in the order of [`Panel::CONTACTS`].
    #[must_use]
    pub const fn contact_pins() -> [Pin; Panel::CONTACTS.len()] {
        [
            Pin::new(Port::C, 6),
            Pin::new(Port::C, 7),
            Pin::new(Port::C, 8),
            Pin::new(Port::C, 9),
            Pin::new(Port::C, 10),
            Pin::new(Port::C, 11),
            Pin::new(Port::C, 12),
            Pin::new(Port::B, 12),
            Pin::new(Port::B, 14),
            Pin::new(Port::B, 5),
            Pin::new(Port::B, 7),
            Pin::new(Port::B, 9),
            Pin::new(Port::A, 10),
            Pin::new(Port::A, 15),
        ]
    }

    /// Full scales of supply and sensor supply: their dividers.
    #[must_use]
    pub const fn supply_scales(self) -> [MilliVolt; 2] {
        match self {
            Self::Stm32f405 | Self::Stm32g474 => {
                let BoardScaling {
                    supply,
                    sensor_supply,
                    ..
                } = BoardScaling::NOMINAL;
                [supply, sensor_supply]
            }
            // 3.3 V without a divider.
            Self::NucleoG474re => [MilliVolt(13_200), MilliVolt(5_000)],
        }
    }
}

impl fmt::Display for Layout {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Layout {
    type Err = Error;

    fn from_str(name: &str) -> Result<Self, Error> {
        match Self::ALL.into_iter().find(|board| board.name() == name) {
            Some(board) => Ok(board),
            None => {
                let known = Self::ALL.map(Self::name);
                bail!(
                    "there is no board `{name}`; take one of {}",
                    known.join(", ")
                )
            }
        }
    }
}
