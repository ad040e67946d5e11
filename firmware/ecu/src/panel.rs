//! The operator's buttons and switches as contacts.

use hitch_quantities::codes;
use hitch_quantities::units::{Count, MilliDegreePerSecond};
use hitch_quantities::{Function, Inputs, Switches};

/// Contacts of buttons and switches. They close to ground, so that a broken wire reads as open.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Panel(u16);

codes! {
    /// One contact of the panel.
    Contact: u16 {
        /// External button: up.
        Up = 1 << 0;
        /// External button: down.
        Down = 1 << 1;
        /// Field/road switch: closed in the field. Open, by hand or by a broken wire, the hitch is locked for the road.
        FieldMode = 1 << 2;
        /// Hold.
        Hold = 1 << 3;
        /// Quick lift.
        QuickLift = 1 << 4;
        /// Service: the external buttons start teaching.
        Service = 1 << 5;
        /// Consent to remote control, a button. Open is no consent.
        Consent = 1 << 6;
        /// Second contact of the button up: closed while it is released. Open, by a press or by a broken wire, it is not.
        UpReleased = 1 << 7;
        /// The same of the button down.
        DownReleased = 1 << 8;
        /// Quick engagement, closed as long as it is held. Open, by hand or by a broken wire, it does not lower.
        Engage = 1 << 9;
        /// Selector of the function: draft. With none of its contacts closed, by hand or by a broken wire, or with more than
        /// one, the lever is the position.
        Draft = 1 << 10;
        /// Selector: mix.
        Mix = 1 << 11;
        /// Selector: depth limit.
        DepthLimit = 1 << 12;
        /// Selector: depth.
        Depth = 1 << 13;
    }
}

impl Panel {
    /// Contacts in the order of their bits.
    pub const CONTACTS: [Contact; Contact::ALL.len()] = Contact::ALL;

    /// A tractor in the field with nothing pressed.
    pub const FIELD: Self =
        Self(Contact::FieldMode as u16 | Contact::UpReleased as u16 | Contact::DownReleased as u16);

    /// The panel with these bits; bits without a contact are ignored.
    #[must_use]
    pub const fn from_bits(bits: u16) -> Self {
        Self(bits & ((1 << Self::CONTACTS.len()) - 1))
    }

    /// One bit for each contact, set if it is closed.
    #[must_use]
    pub const fn bits(self) -> u16 {
        self.0
    }

    /// The panel with one contact closed or opened.
    #[must_use]
    pub const fn with(self, contact: Contact, closed: bool) -> Self {
        if closed {
            Self(self.0 | contact as u16)
        } else {
            Self(self.0 & !(contact as u16))
        }
    }

    /// Whether the contact is closed.
    #[must_use]
    pub const fn is_closed(self, contact: Contact) -> bool {
        self.0 & contact as u16 != 0
    }

    /// The panel with these external buttons pressed, and no other, in a wiring with two contacts a button.
    #[must_use]
    pub const fn with_buttons(self, up: bool, down: bool) -> Self {
        self.with(Contact::Up, up)
            .with(Contact::UpReleased, !up)
            .with(Contact::Down, down)
            .with(Contact::DownReleased, !down)
    }

    /// Request of the external buttons, at the rate limit of the calibration. Both pressed are a request of no rate, so
    /// that a shorted wire does not look released when the other button is.
    fn jog(self) -> Option<MilliDegreePerSecond> {
        match (self.is_closed(Contact::Up), self.is_closed(Contact::Down)) {
            (true, false) => Some(MilliDegreePerSecond(i32::MAX)),
            (false, true) => Some(MilliDegreePerSecond(-i32::MAX)),
            (true, true) => Some(MilliDegreePerSecond(0)),
            (false, false) => None,
        }
    }

    /// The function whose contact is the only closed one of the selector.
    const fn function(self) -> Function {
        const DRAFT: u16 = Contact::Draft as u16;
        const MIX: u16 = Contact::Mix as u16;
        const DEPTH_LIMIT: u16 = Contact::DepthLimit as u16;
        const DEPTH: u16 = Contact::Depth as u16;
        match self.0 & (DRAFT | MIX | DEPTH_LIMIT | DEPTH) {
            DRAFT => Function::Draft,
            MIX => Function::Mix,
            DEPTH_LIMIT => Function::DepthLimit,
            DEPTH => Function::Depth,
            _ => Function::Position,
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
                up_released: self.is_closed(Contact::UpReleased),
                down_released: self.is_closed(Contact::DownReleased),
                engage: self.is_closed(Contact::Engage),
            },
            function: Some(Count(self.function() as i32)),
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
    fn a_function_is_selected_by_its_contact_alone() {
        let selected = |contacts: &[Contact]| {
            let closed = |panel: Panel, contact: &Contact| panel.with(*contact, true);
            let panel = contacts.iter().fold(Panel::FIELD, closed);
            Function::from_code(panel.added_to(Inputs::default()).function)
        };
        let contacts = [
            (Contact::Draft, Function::Draft),
            (Contact::Mix, Function::Mix),
            (Contact::DepthLimit, Function::DepthLimit),
            (Contact::Depth, Function::Depth),
        ];
        assert_eq!(selected(&[]), Function::Position);
        for (contact, function) in contacts {
            assert_eq!(selected(&[contact]), function);
            for (other, _) in contacts.into_iter().filter(|(other, _)| *other != contact) {
                assert_eq!(selected(&[contact, other]), Function::Position);
            }
        }
    }

    #[test]
    fn bits_go_round() {
        for contact in Panel::CONTACTS {
            let panel = Panel::default().with(contact, true);
            assert_eq!(Panel::from_bits(panel.bits()), panel, "{contact:?}");
        }
        assert_eq!(Panel::from_bits(u16::MAX).bits().count_ones(), 14);
    }

    #[test]
    fn both_buttons_are_a_request_of_no_rate() {
        let jog = |up, down| {
            let panel = Panel::FIELD.with_buttons(up, down);
            panel.added_to(Inputs::default()).jog.map(|jog| jog.0)
        };
        assert_eq!(jog(true, false), Some(i32::MAX));
        assert_eq!(jog(false, true), Some(-i32::MAX));
        assert_eq!(jog(true, true), Some(0));
        assert_eq!(jog(false, false), None);
    }
}
