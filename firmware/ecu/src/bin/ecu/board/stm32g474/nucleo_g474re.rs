//! ST's board NUCLEO-G474RE (UM2505), to try the image out on a desk: crystal, converter inputs and scaling.
//!
//! On this board the probe's serial port is on PA2 and PA3, and an LED on PA5. So the lift current is on PA4, the upper-limit
//! dial on PC3, and there is no second track. Potentiometers and supplies are taken from the board's 3.3 V, without dividers.

use hitch_ecu::{AdcCode, BoardScaling, Signal};
use hitch_quantities::calibration::fitted::Fitted;
use hitch_quantities::units::MilliVolt;
use stm32_metapac::gpio::Gpio;
use stm32_metapac::rcc::vals::Pllm;
use stm32_metapac::{GPIOA, GPIOB, GPIOC};

use super::factory_reference::REFERENCE;

/// X3, the crystal of the board.
pub const CRYSTAL_HZ: u32 = 24_000_000;
/// The PLL gets 4 MHz.
pub const CRYSTAL_DIVIDER: Pllm = Pllm::DIV6;

/// The converters' inputs.
pub const ANALOG_PINS: [(Gpio, &[usize]); 3] = [
    (GPIOA, &[0, 1, 4, 5, 6, 7]),
    (GPIOB, &[0, 1, 13, 15]),
    (GPIOC, &[0, 1, 2, 3, 4, 5]),
];

/// The channels of the three sequences in the order of their ranks, with their signals.
pub const SEQUENCES: [[(u8, Signal); 4]; 3] = [
    [
        (6, Signal::LowerCurrent),     // PC0, A5
        (1, Signal::RockerAngle),      // PA0, A0
        (9, Signal::UpperLimit),       // PC3
        (8, Signal::CylinderPressure), // PC2
    ],
    [
        (17, Signal::LiftCurrent), // PA4, A2
        (2, Signal::Lever),        // PA1, A1
        (7, Signal::LoweringDial), // PC1, A4
        (13, Signal::SecondAngle), // PA5, not fitted
    ],
    [
        (1, Signal::PumpPressure), // PB1
        (12, Signal::Supply),      // PB0, A3
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

/// 3.3 V are a sensor supply of 5 V and a supply of 13.2 V.
pub const SCALING: BoardScaling = BoardScaling {
    // A band gap of 1.212 V, 1.182 to 1.232 V (DS12288, VREFINT).
    reference: AdcCode::new(1_504),
    supply: MilliVolt(13_200),
    sensor_supply: MilliVolt(5_000),
    fitted: Fitted {
        second_track: false,
        second_contact: true,
    },
    ..BoardScaling::NOMINAL
};
