//! Row 22: a current on the set point of an implement needs the operator's consent, as the contacts show it.

use hitch_quantities::calibration::design_parameters::RemoteParameters;
use hitch_quantities::units::{Count, MilliDegree, MilliDegreePerSecond};
use hitch_quantities::{CoilCurrents, Inputs, Trip};
use hitch_safety::Limits;

use crate::{LIFT, LOWER, Order, Rig, limits};

/// An implement's set point.
const ASKED: Option<MilliDegree> = Some(MilliDegree(100_000));

fn by(kind: i32) -> RemoteParameters {
    RemoteParameters {
        consent: Count(kind),
        ..RemoteParameters::NOMINAL
    }
}

/// A hitch at rest after a move by the lever, with a way to consent.
struct Remote {
    rig: Rig,
    parameters: RemoteParameters,
}

impl Remote {
    fn at_rest(kind: i32) -> Self {
        let mut rig = Rig::moving(LIFT);
        rig.speed = 0;
        rig.run(Order::Rest, 200);
        Self {
            rig,
            parameters: by(kind),
        }
    }

    fn step(&mut self, order: Order, alter: impl FnOnce(&mut Inputs)) -> CoilCurrents {
        let limits = Limits {
            remote: &self.parameters,
            ..limits()
        };
        self.rig.step_within(limits, order, alter)
    }

    /// Steps at rest with the contact closed or open.
    fn contact(&mut self, closed: bool, ms: usize) {
        for _ in 0..ms {
            self.step(Order::Rest, |inputs| inputs.switches.consent = closed);
        }
    }

    /// The contact is pressed and released.
    fn press(&mut self) {
        self.contact(false, 20);
        self.contact(true, 20);
        self.contact(false, 1);
    }

    /// The lever is moved from its place in strokes of 3 degrees, `ms` each.
    fn swing(&mut self, strokes: i32, ms: i32) {
        for stroke in 0..strokes {
            for step in 1..=ms {
                let share = 3_000 * step / ms;
                let away = if stroke % 2 == 0 {
                    share
                } else {
                    3_000 - share
                };
                self.step(Order::Rest, |inputs| {
                    let lever = inputs.lever.unwrap();
                    inputs.lever = Some(lever + MilliDegree(away));
                });
            }
        }
    }

    /// Whether an implement moves the hitch now. If it doesn't, row 22 has tripped with the first current.
    fn moves(&mut self) -> bool {
        let first = self.step(LIFT, |inputs| inputs.set_point = ASKED);
        assert_ne!(first, CoilCurrents::OFF, "armed by the lever");
        let second = self.step(LIFT, |inputs| inputs.set_point = ASKED);
        match self.rig.envelope.tripped() {
            None => second != CoilCurrents::OFF,
            Some(trip) => {
                assert_eq!((trip, second), (Trip::NoConsent, CoilCurrents::OFF));
                false
            }
        }
    }

    /// An implement has the hitch.
    fn active(order: Order) -> Self {
        let mut remote = Self::at_rest(1);
        remote.press();
        for _ in 0..50 {
            let passed = remote.step(order, |inputs| inputs.set_point = ASKED);
            assert_ne!(passed, CoilCurrents::OFF);
        }
        remote
    }
}

// REQ-SAFE-15
#[test]
fn a_set_point_without_consent_trips_with_its_first_current() {
    for kind in 0..=2 {
        assert!(!Remote::at_rest(kind).moves(), "{kind}");
    }
    for order in [LIFT, LOWER] {
        let mut rig = Rig::moving(order);
        let cut = rig.cut_after(order, |inputs, _| inputs.set_point = ASKED);
        assert_eq!(
            (cut, rig.envelope.tripped()),
            (Some(1), Some(Trip::NoConsent))
        );
    }
}

// REQ-SAFE-15
#[test]
fn a_set_point_without_a_current_is_harmless() {
    let mut remote = Remote::at_rest(1);
    for _ in 0..1_000 {
        remote.step(Order::Rest, |inputs| inputs.set_point = ASKED);
    }
    assert_eq!(remote.rig.envelope.tripped(), None);
}

// REQ-SAFE-15
#[test]
fn the_contact_consents_when_it_closes_after_it_was_open() {
    let mut pressed = Remote::at_rest(1);
    pressed.press();
    assert!(pressed.moves());
    for (open, closed) in [(19, 20), (20, 19), (0, 1_000)] {
        let mut remote = Remote::at_rest(1);
        remote.contact(true, 100);
        // The consent of this closing is over.
        remote.contact(true, 3_000);
        remote.contact(false, open);
        remote.contact(true, closed);
        assert!(!remote.moves(), "{open} ms open, {closed} ms closed");
    }
    let mut again = Remote::at_rest(1);
    again.contact(true, 3_000);
    again.contact(false, 20);
    again.contact(true, 20);
    assert!(again.moves());
}

// REQ-SAFE-15
#[test]
fn a_consent_is_good_for_two_seconds_and_one_set_point() {
    let mut remote = Remote::at_rest(1);
    remote.press();
    remote.contact(false, 1_999);
    assert!(remote.moves());
    let mut late = Remote::at_rest(1);
    late.press();
    late.contact(false, 2_000);
    assert!(!late.moves());
    let mut second = Remote::active(LIFT);
    second.contact(false, 1);
    assert!(!second.moves());
}

// REQ-SAFE-15
#[test]
fn the_calibration_says_what_consents() {
    for (kind, by_contact, by_lever) in [(0, false, false), (1, true, false), (2, false, true)] {
        let mut remote = Remote::at_rest(kind);
        remote.press();
        assert_eq!(remote.moves(), by_contact, "{kind}");
        let mut remote = Remote::at_rest(kind);
        remote.swing(4, 200);
        assert_eq!(remote.moves(), by_lever, "{kind}");
    }
}

// REQ-SAFE-15
#[test]
fn the_lever_consents_when_it_is_moved_there_and_back_twice() {
    for (strokes, ms, consents) in [
        (4, 100, true),
        (4, 500, true),
        (3, 200, false),
        (4, 1_500, false),
        (6, 200, false),
        (8, 200, true),
    ] {
        let mut remote = Remote::at_rest(2);
        remote.swing(strokes, ms);
        if strokes > 4 {
            // The consent of the first four is over.
            remote.contact(false, 1_700);
        }
        assert_eq!(remote.moves(), consents, "{strokes} strokes of {ms} ms");
    }
    let mut lost = Remote::at_rest(2);
    lost.swing(2, 200);
    lost.step(Order::Rest, |inputs| inputs.lever = None);
    lost.swing(2, 200);
    assert!(!lost.moves());
}

/// What ends the consent in a step in which the implement still has the hitch.
fn ends(alter: impl Fn(&mut Inputs)) -> bool {
    let mut remote = Remote::active(LIFT);
    remote.step(LIFT, |inputs| {
        inputs.set_point = ASKED;
        alter(inputs);
    });
    remote.step(LIFT, |inputs| inputs.set_point = ASKED);
    let tripped = remote.rig.envelope.tripped();
    assert!(tripped.is_none() || tripped == Some(Trip::NoConsent));
    tripped.is_some()
}

// REQ-SAFE-15
#[test]
fn lever_and_button_end_it() {
    let moved = |by: i32| {
        move |inputs: &mut Inputs| {
            let lever = inputs.lever.unwrap();
            inputs.lever = Some(lever + MilliDegree(by));
        }
    };
    assert!(!ends(|_| {}));
    assert!(!ends(moved(1_500)) && !ends(moved(-1_500)));
    assert!(ends(moved(1_501)) && ends(moved(-1_501)));
    assert!(ends(|inputs| inputs.jog = Some(MilliDegreePerSecond(5_000))));
    assert!(!ends(|inputs| inputs.lever = None), "one sample is bridged");
}

// REQ-SAFE-15
#[test]
fn after_a_lock_a_set_point_needs_another_consent() {
    type Alter = fn(&mut Inputs);
    let locks: [Alter; 2] = [
        |inputs| inputs.switches.hold = true,
        |inputs| inputs.switches.transport_lock = true,
    ];
    for alter in locks {
        let mut remote = Remote::active(LIFT);
        let locked = remote.step(LIFT, |inputs| {
            inputs.set_point = ASKED;
            alter(inputs);
        });
        assert_eq!(locked, CoilCurrents::OFF);
        assert_eq!(remote.rig.envelope.tripped(), None, "a lock is no fault");
        remote.step(Order::Rest, |inputs| {
            inputs.lever = Some(MilliDegree(92_000))
        });
        remote.step(Order::Rest, |inputs| {
            inputs.lever = Some(MilliDegree(94_000))
        });
        assert!(!remote.moves());
    }
}

// REQ-SAFE-15
#[test]
fn an_implement_without_a_lever_signal_is_not_covered() {
    let mut remote = Remote::at_rest(1);
    remote.press();
    remote.step(Order::Rest, |inputs| {
        inputs.set_point = ASKED;
        inputs.lever = None;
    });
    assert!(!remote.moves());
}

#[test]
fn an_implement_does_not_hide_a_broken_lever() {
    let mut remote = Remote::active(LIFT);
    let cut = (1..=10).find(|_| {
        remote.step(LIFT, |inputs| {
            inputs.set_point = ASKED;
            inputs.lever = None;
        }) == CoilCurrents::OFF
    });
    assert_eq!(
        (cut, remote.rig.envelope.tripped()),
        (Some(5), Some(Trip::Lever))
    );
}
