//! The operator's contacts, in the order of their bits; closed is low.

use hitch_ecu::PanelInputs;
use stm32_metapac::gpio::Gpio;
use stm32_metapac::{GPIOA, GPIOB, GPIOC};

use super::pins::{self, Pin};

/// The contacts on this board.
pub type Switches = PanelInputs<Pin>;

/// Their pins. PB4 and PB6 are left out: after a reset the STM32G474 pulls them down (RM0440, UCPD, dead battery).
const CONTACTS: [(Gpio, usize); 14] = [
    (GPIOC, 6),
    (GPIOC, 7),
    (GPIOC, 8),
    (GPIOC, 9),
    (GPIOC, 10),
    (GPIOC, 11),
    (GPIOC, 12),
    (GPIOB, 12),
    (GPIOB, 14),
    (GPIOB, 5),
    (GPIOB, 7),
    (GPIOB, 9),
    (GPIOA, 10),
    (GPIOA, 15),
];

/// Pulls the contacts up.
pub fn start() -> Switches {
    PanelInputs::new(CONTACTS.map(|(port, pin)| {
        pins::input_with_pull_up(port, pin);
        Pin::new(port, pin)
    }))
}
