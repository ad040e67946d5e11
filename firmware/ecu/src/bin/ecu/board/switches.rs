//! The operator's contacts on PC6 to PC12, PC4 and PC5, in the order of their bits; closed is low.

use hitch_ecu::PanelInputs;
use stm32_metapac::GPIOC;

use super::pins::{self, Pin};

/// The contacts on this board.
pub type Switches = PanelInputs<Pin>;

/// Pulls the contacts up.
pub fn start() -> Switches {
    PanelInputs::new([6, 7, 8, 9, 10, 11, 12, 4, 5].map(|pin| {
        pins::input_with_pull_up(GPIOC, pin);
        Pin::new(GPIOC, pin)
    }))
}
