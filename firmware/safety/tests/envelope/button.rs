//! The external button: which presses arm, and how far one moves the hitch.

use hitch_quantities::Switches;
use hitch_quantities::units::Count;

use super::*;

const TWO_CONTACTS: OperatorParameters = OperatorParameters {
    second_contact: Count(1),
    ..OperatorParameters::NOMINAL
};
/// Steps in which the rig below moves by the longest travel.
const SPENT: usize = 30_000 / FULL_SPEED as usize;

/// Request of the button, and whether the second contacts of up and down say released.
type Contacts = (Option<i32>, bool, bool);
const RELEASED: Contacts = (None, true, true);
const UP: Contacts = (Some(5_000), false, true);
const DOWN: Contacts = (Some(-5_000), true, false);
const BOTH: Contacts = (Some(0), false, false);
const SHORTED: Contacts = (Some(5_000), true, true);

struct Buttons {
    rig: Rig,
    limits: Limits<'static>,
    teach: bool,
}

impl Buttons {
    /// Never touched, with one or two contacts in each button.
    fn new(operator: &'static OperatorParameters) -> Self {
        let mut rig = Rig::new();
        rig.angle = 70_000;
        Self {
            rig,
            limits: Limits {
                operator,
                ..limits()
            },
            teach: false,
        }
    }

    /// The same, seen released.
    fn released(operator: &'static OperatorParameters) -> Self {
        let mut buttons = Self::new(operator);
        buttons.on_for(Order::Rest, RELEASED, 20);
        buttons
    }

    /// Steps with these contacts; in how many of them a coil was on. The hitch moves with its lift coil.
    fn on_for(
        &mut self,
        order: Order,
        (jog, up_released, down_released): Contacts,
        steps: usize,
    ) -> usize {
        let switches = Switches {
            up_released,
            down_released,
            teach: self.teach,
            ..Switches::default()
        };
        (0..steps)
            .filter(|_| {
                let passed = self.rig.step_within(self.limits, order, |inputs| {
                    inputs.jog = jog.map(MilliDegreePerSecond);
                    inputs.switches = switches;
                });
                self.rig.speed = if passed.lift > MilliAmp(0) {
                    FULL_SPEED
                } else {
                    0
                };
                passed != CoilCurrents::OFF
            })
            .count()
    }
}

#[test]
fn a_press_arms_up_to_its_longest_travel() {
    let mut buttons = Buttons::released(&OperatorParameters::NOMINAL);
    let on = buttons.on_for(LIFT, UP, 2_000);
    assert!((SPENT - 2..=SPENT + 2).contains(&on), "{on} steps");
    let moved = buttons.rig.angle - 70_000;
    assert!((29_800..=30_120).contains(&moved), "{moved}");
    assert_eq!(buttons.rig.envelope.tripped(), None);
    assert_eq!(buttons.on_for(Order::Rest, RELEASED, 19), 0);
    assert_eq!(buttons.on_for(LIFT, UP, 100), 0, "a bounce");
    assert_eq!(buttons.on_for(Order::Rest, RELEASED, 20), 0);
    assert_eq!(buttons.on_for(LIFT, UP, 100), 100, "the next press");
}

#[test]
fn the_ramp_after_the_release_counts_as_well() {
    let mut buttons = Buttons::released(&OperatorParameters::NOMINAL);
    assert_eq!(buttons.on_for(LIFT, UP, 300), 300);
    let on = 300 + buttons.on_for(LIFT, RELEASED, 2_000);
    assert!((SPENT - 2..=SPENT + 2).contains(&on), "{on} steps");
}

#[test]
fn a_bounce_begins_no_press_and_a_release_does() {
    for (released, begins) in [(19, false), (20, true)] {
        let mut buttons = Buttons::released(&OperatorParameters::NOMINAL);
        assert_eq!(buttons.on_for(LIFT, UP, 300), 300);
        assert_eq!(buttons.on_for(LIFT, RELEASED, released), released);
        let on = buttons.on_for(LIFT, UP, 400);
        assert_eq!(on == 400, begins, "{on} steps after {released} ms");
    }
}

#[test]
fn teaching_moves_further() {
    let mut buttons = Buttons::released(&OperatorParameters::NOMINAL);
    buttons.teach = true;
    assert_eq!(buttons.on_for(LIFT, UP, SPENT + 100), SPENT + 100);
    buttons.teach = false;
    assert_eq!(buttons.on_for(LIFT, UP, 100), 0, "since its beginning");
}

#[test]
fn both_buttons_arm_nothing_and_are_no_release() {
    for operator in [&OperatorParameters::NOMINAL, &TWO_CONTACTS] {
        let mut buttons = Buttons::released(operator);
        assert_eq!(buttons.on_for(LIFT, BOTH, 1_000), 0);
        let mut buttons = Buttons::released(operator);
        buttons.on_for(LIFT, UP, 2_000);
        assert_eq!(buttons.on_for(Order::Rest, BOTH, 100), 0);
        assert_eq!(buttons.on_for(LIFT, UP, 100), 0);
    }
}

#[test]
fn two_contacts_have_to_agree() {
    for contacts in [UP, DOWN] {
        let mut buttons = Buttons::released(&TWO_CONTACTS);
        assert_eq!(buttons.on_for(LIFT, contacts, 1), 1);
    }
    for contacts in [
        SHORTED,
        (Some(-5_000), true, true),
        (Some(5_000), false, false),
        (Some(-5_000), false, false),
        (Some(5_000), true, false),
        (Some(0), true, false),
        (Some(0), false, true),
        (None, false, true),
        (None, true, false),
        (None, false, false),
    ] {
        let mut buttons = Buttons::released(&TWO_CONTACTS);
        assert_eq!(buttons.on_for(LIFT, contacts, 199), 0, "{contacts:?}");
        assert_eq!(buttons.on_for(LIFT, UP, 1), 1, "a slow finger");
        let mut buttons = Buttons::released(&TWO_CONTACTS);
        assert_eq!(buttons.on_for(LIFT, contacts, 200), 0);
        assert_eq!(buttons.on_for(LIFT, UP, 100), 0, "since {contacts:?}");
        buttons.on_for(Order::Rest, RELEASED, 20);
        assert_eq!(buttons.on_for(LIFT, UP, 1), 1);
        let mut buttons = Buttons::new(&TWO_CONTACTS);
        buttons.on_for(Order::Rest, contacts, 100);
        assert_eq!(buttons.on_for(LIFT, UP, 100), 0, "never released");
    }
}

#[test]
fn a_shorted_wire_moves_nothing_with_two_contacts() {
    let mut buttons = Buttons::released(&TWO_CONTACTS);
    assert_eq!(buttons.on_for(LIFT, SHORTED, 8_000), 0);
}

#[test]
fn a_spent_press_stays_spent_where_the_hitch_sinks_back() {
    let mut buttons = Buttons::released(&OperatorParameters::NOMINAL);
    buttons.on_for(LIFT, UP, 2_000);
    for _ in 0..2_000 {
        buttons.rig.speed = -10;
        buttons.on_for(Order::Rest, UP, 1);
    }
    let sunk = buttons.rig.angle - 70_000;
    assert!(sunk < 15_000, "{sunk}");
    assert_eq!(buttons.rig.envelope.tripped(), None);
    assert_eq!(buttons.on_for(LIFT, UP, 100), 0);
}
