//! The operator's contacts on PC6 to PC11, in the order of their bits; closed is low.

use hitch_firmware::ecu::Panel;
use stm32_metapac::GPIOC;
use stm32_metapac::gpio::vals::Idr;

use super::pins;

const FIRST_PIN: usize = 6;

/// The contacts.
pub struct SwitchInputs(());

impl SwitchInputs {
    /// Pulls them up.
    pub fn start() -> Self {
        for index in 0..Panel::CONTACTS.len() {
            pins::input_with_pull_up(GPIOC, FIRST_PIN + index);
        }
        Self(())
    }

    /// The contacts as they are now. Bouncing does no harm: what they start is guarded or ramped by the controller.
    pub fn read(&self) -> Panel {
        let port = GPIOC.idr().read();
        let pins = FIRST_PIN..FIRST_PIN + Panel::CONTACTS.len();
        let bits = pins.rev().fold(0, |bits, pin| {
            (bits << 1) | u8::from(port.idr(pin) == Idr::LOW)
        });
        Panel::from_bits(bits)
    }
}
