//! The operator's contacts on microcontroller pins.

use embedded_hal::digital::InputPin;

use super::panel::Panel;

/// Number of contacts.
const CONTACTS: usize = Panel::CONTACTS.len();

/// Inputs with pull-up, in the order of [`Panel::CONTACTS`]; a closed contact is low.
#[derive(Debug)]
pub struct PanelInputs<Pin>([Pin; CONTACTS]);

impl<Pin: InputPin> PanelInputs<Pin> {
    /// The contacts on these pins.
    #[must_use]
    pub const fn new(pins: [Pin; CONTACTS]) -> Self {
        Self(pins)
    }

    /// The present state of the contacts. Contact bounce is harmless: the controller guards or ramps the functions. If
    /// a pin cannot be read, all contacts count as open, which locks the hitch.
    pub fn read(&mut self) -> Panel {
        let mut panel = Panel::default();
        for (pin, contact) in self.0.iter_mut().zip(Panel::CONTACTS) {
            let Ok(closed) = pin.is_low() else {
                return Panel::default();
            };
            panel = panel.with(contact, closed);
        }
        panel
    }

    /// Returns the pins.
    #[must_use]
    pub fn release(self) -> [Pin; CONTACTS] {
        self.0
    }
}
