//! The ECU's board with an STM32G474RE: crystal, converter inputs and scaling.

use hitch_ecu::{AdcCode, BoardScaling, Signal};
use hitch_quantities::calibration::fitted::Fitted;
use stm32_metapac::gpio::Gpio;
use stm32_metapac::rcc::vals::Pllm;
use stm32_metapac::{GPIOA, GPIOB, GPIOC};

use super::factory_reference::REFERENCE;

/// The crystal that the image is made for.
pub const CRYSTAL_HZ: u32 = 8_000_000;
/// The PLL gets 4 MHz.
pub const CRYSTAL_DIVIDER: Pllm = Pllm::DIV2;

/// The converters' inputs.
pub const ANALOG_PINS: [(Gpio, &[usize]); 3] = [
    (GPIOA, &[0, 1, 2, 3, 5, 6, 7]),
    (GPIOB, &[0, 1, 13, 15]),
    (GPIOC, &[0, 1, 2, 4, 5]),
];

/// The channels of the three sequences in the order of their ranks, with their signals.
pub const SEQUENCES: [[(u8, Signal); 4]; 3] = [
    [
        (3, Signal::LiftCurrent),      // PA2
        (1, Signal::RockerAngle),      // PA0
        (4, Signal::UpperLimit),       // PA3
        (8, Signal::CylinderPressure), // PC2
    ],
    [
        (6, Signal::LowerCurrent), // PC0
        (2, Signal::Lever),        // PA1
        (7, Signal::LoweringDial), // PC1
        (13, Signal::SecondAngle), // PA5
    ],
    [
        (1, Signal::PumpPressure), // PB1
        (12, Signal::Supply),      // PB0
        (5, Signal::SensorSupply), // PB13
        (REFERENCE, Signal::Reference),
    ],
];

/// The slow channels of ADC2 in the order of their conversions.
pub const SLOW: [(u8, Signal); 5] = [
    (3, Signal::LeftPin),       // PA6
    (4, Signal::RightPin),      // PA7
    (15, Signal::DepthSensor),  // PB15
    (5, Signal::MixDial),       // PC4
    (11, Signal::SetPointDial), // PC5
];

/// The nominal board's, with a second track of the rocker-angle sensor on PA5.
pub const SCALING: BoardScaling = BoardScaling {
    // A band gap of 1.212 V, 1.182 to 1.232 V (DS12288, VREFINT).
    reference: AdcCode::new(1_504),
    fitted: Fitted {
        second_track: true,
        second_contact: true,
    },
    ..BoardScaling::NOMINAL
};
