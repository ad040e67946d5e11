//! Trouble codes of the external buttons: a contact that stays closed, and contacts that contradict each other.

use hitch_quantities::Inputs;
use hitch_quantities::calibration::design_parameters::OperatorParameters;

use super::trouble::{Trouble, Troubles};

/// Release that counts, ms: longer than a contact bounces.
const RELEASED_MS: u16 = 20;
/// How long a contact has to be closed since power-up, ms.
const CLOSED_AT_START_MS: u16 = 100;
/// How long one has to be closed later, ms: longer than a press moves the hitch.
const CLOSED_MS: u16 = 10_000;
/// How long contacts have to contradict each other, ms: longer than a slow finger takes.
const CONTRADICTING_MS: u16 = 200;

/// Monitors the contacts of the buttons.
#[derive(Clone, Copy, Debug, Default)]
pub struct ButtonMonitor {
    was_released: bool,
    released_ms: u16,
    closed_ms: u16,
    contradicting_ms: u16,
}

impl ButtonMonitor {
    /// One millisecond. A button that teaches may be held for any time.
    pub fn update(&mut self, inputs: &Inputs, operator: &OperatorParameters) -> Troubles {
        let closed = inputs.jog.is_some();
        let contradicting = operator.second_contact.0 != 0 && contradict(inputs);
        let counted = |is: bool, ms: u16| if is { ms.saturating_add(1) } else { 0 };
        self.closed_ms = counted(closed && !contradicting, self.closed_ms);
        self.released_ms = counted(!closed && !contradicting, self.released_ms);
        self.contradicting_ms = counted(contradicting, self.contradicting_ms);
        self.was_released |= self.released_ms >= RELEASED_MS;
        let longest_ms = if self.was_released {
            CLOSED_MS
        } else {
            CLOSED_AT_START_MS
        };
        let mut found = Troubles::NONE;
        if self.contradicting_ms >= CONTRADICTING_MS {
            found.insert(Trouble::ButtonContacts);
        }
        if self.closed_ms >= longest_ms && !(inputs.switches.teach && self.was_released) {
            found.insert(Trouble::ButtonClosed);
        }
        found
    }
}

/// Whether a contact contradicts its twin. Both buttons pressed are a request of no rate.
fn contradict(inputs: &Inputs) -> bool {
    let (up, down) = match inputs.jog {
        None => (false, false),
        Some(jog) => (jog.0 >= 0, jog.0 <= 0),
    };
    inputs.switches.up_released == up || inputs.switches.down_released == down
}

#[cfg(test)]
mod tests {
    use hitch_quantities::Switches;
    use hitch_quantities::units::{Count, MilliDegreePerSecond};

    use super::*;

    /// Contacts: request, and whether the second contacts of up and down say released.
    type Contacts = (Option<i32>, bool, bool);
    const RELEASED: Contacts = (None, true, true);
    const UP: Contacts = (Some(1), false, true);

    /// Codes after these contacts for so many milliseconds each.
    fn after(second: i32, teach: bool, phases: &[(Contacts, usize)]) -> Troubles {
        let operator = OperatorParameters {
            second_contact: Count(second),
            ..OperatorParameters::NOMINAL
        };
        let mut monitor = ButtonMonitor::default();
        let mut found = Troubles::NONE;
        for &((jog, up_released, down_released), ms) in phases {
            let inputs = Inputs {
                jog: jog.map(MilliDegreePerSecond),
                switches: Switches {
                    up_released,
                    down_released,
                    teach,
                    ..Switches::default()
                },
                ..Inputs::default()
            };
            for _ in 0..ms {
                found = monitor.update(&inputs, &operator);
            }
        }
        found
    }

    #[test]
    fn a_contact_that_is_closed_at_power_up_or_for_long_is_told() {
        let closed = Troubles::from(Trouble::ButtonClosed);
        for second in [0, 1] {
            assert_eq!(after(second, false, &[(UP, 99)]), Troubles::NONE);
            assert_eq!(after(second, false, &[(UP, 100)]), closed);
            let start = (RELEASED, 20);
            assert_eq!(after(second, false, &[start, (UP, 9_999)]), Troubles::NONE);
            assert_eq!(after(second, false, &[start, (UP, 10_000)]), closed);
            assert_eq!(after(second, true, &[start, (UP, 60_000)]), Troubles::NONE);
            assert_eq!(
                after(second, false, &[(UP, 100), (RELEASED, 1)]),
                Troubles::NONE
            );
        }
    }

    #[test]
    fn contacts_that_contradict_each_other_are_told() {
        let told = Troubles::from(Trouble::ButtonContacts);
        let cases = [
            (Some(1), true, true),
            (Some(1), false, false),
            (Some(-1), true, true),
            (Some(0), false, true),
            (None, false, false),
            (None, true, false),
        ];
        for contacts in cases {
            assert_eq!(after(1, false, &[(contacts, 199)]), Troubles::NONE);
            assert_eq!(after(1, false, &[(RELEASED, 50), (contacts, 200)]), told);
            assert_eq!(
                after(0, false, &[(RELEASED, 50), (contacts, 200)]),
                Troubles::NONE
            );
        }
        for healthy in [
            RELEASED,
            UP,
            (Some(-1), true, false),
            (Some(0), false, false),
        ] {
            assert_eq!(
                after(1, false, &[(RELEASED, 50), (healthy, 1_000)]),
                Troubles::NONE
            );
        }
    }
}
