//! The operator's buttons and switches as contacts.

use hitch_quantities::units::MilliDegreePerSecond;
use hitch_quantities::{Inputs, Switches};

/// Contacts of buttons and switches. They close to ground, so that a broken wire reads as open.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Panel(u8);

/// One contact of the panel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Contact {
    /// External button: up.
    Up = 1 << 0,
    /// External button: down.
    Down = 1 << 1,
    /// Field/road switch: closed in the field. Open, by hand or by a broken wire, the hitch is locked for the road.
    FieldMode = 1 << 2,
    /// Hold.
    Hold = 1 << 3,
    /// Quick lift.
    QuickLift = 1 << 4,
    /// Service: the external buttons start teaching.
    Service = 1 << 5,
    /// Consent to remote control, a button. Open is no consent.
    Consent = 1 << 6,
}

impl Panel {
    /// Contacts in the order of their bits.
    pub const CONTACTS: [Contact; 7] = [
        Contact::Up,
        Contact::Down,
        Contact::FieldMode,
        Contact::Hold,
        Contact::QuickLift,
        Contact::Service,
        Contact::Consent,
    ];

    /// A tractor in the field with nothing pressed.
    pub const FIELD: Self = Self(Contact::FieldMode as u8);

    /// The panel with these bits; bits without a contact are ignored.
    #[must_use]
    pub const fn from_bits(bits: u8) -> Self {
        Self(bits & 0b111_1111)
    }

    /// One bit for each contact, set if it is closed.
    #[must_use]
    pub const fn bits(self) -> u8 {
        self.0
    }

    /// The panel with one contact closed or opened.
    #[must_use]
    pub const fn with(self, contact: Contact, closed: bool) -> Self {
        match closed {
            true => Self(self.0 | contact as u8),
            false => Self(self.0 & !(contact as u8)),
        }
    }

    /// Whether the contact is closed.
    #[must_use]
    pub const fn is_closed(self, contact: Contact) -> bool {
        self.0 & contact as u8 != 0
    }

    /// Request of the external buttons, at the rate limit of the calibration. Both pressed count as none.
    fn jog(self) -> Option<MilliDegreePerSecond> {
        match (self.is_closed(Contact::Up), self.is_closed(Contact::Down)) {
            (true, false) => Some(MilliDegreePerSecond(i32::MAX)),
            (false, true) => Some(MilliDegreePerSecond(-i32::MAX)),
            _ => None,
        }
    }

    /// Adds the panel's state to the inputs of a step.
    #[must_use]
    pub fn added_to(self, inputs: Inputs) -> Inputs {
        Inputs {
            jog: self.jog(),
            switches: Switches {
                transport_lock: !self.is_closed(Contact::FieldMode),
                hold: self.is_closed(Contact::Hold),
                quick_lift: self.is_closed(Contact::QuickLift),
                teach: self.is_closed(Contact::Service),
                consent: self.is_closed(Contact::Consent),
            },
            ..inputs
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panel_without_wires_is_locked_and_asks_for_nothing() {
        let inputs = Panel::default().added_to(Inputs::default());
        assert!(inputs.switches.transport_lock);
        assert_eq!(inputs.jog, None);
    }

    #[test]
    fn both_buttons_are_none() {
        let up = Panel::FIELD.with(Contact::Up, true);
        assert!(up.added_to(Inputs::default()).jog.is_some());
        let both = up.with(Contact::Down, true);
        assert_eq!(both.added_to(Inputs::default()).jog, None);
    }
}
