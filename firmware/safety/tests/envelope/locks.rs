//! The operator's locks, and what arms after them.

use hitch_quantities::Switches;
use hitch_quantities::units::{Count, RevolutionPerMinute};

use super::*;

const LOCK: LockParameters = LockParameters::NOMINAL;

/// A state of the operator's contacts and of the engine.
type State = fn(&mut Inputs);

fn open(_: &mut Inputs) {}

fn transport_lock(inputs: &mut Inputs) {
    inputs.switches.transport_lock = true;
}

fn hold(inputs: &mut Inputs) {
    inputs.switches.hold = true;
}

fn pressed(inputs: &mut Inputs) {
    inputs.jog = Some(MilliDegreePerSecond(5_000));
}

fn held_and_pressed(inputs: &mut Inputs) {
    hold(inputs);
    pressed(inputs);
}

fn locked_and_pressed(inputs: &mut Inputs) {
    transport_lock(inputs);
    pressed(inputs);
}

fn lever_elsewhere(inputs: &mut Inputs) {
    inputs.lever = Some(MilliDegree(91_000));
}

fn held_with_the_lever_elsewhere(inputs: &mut Inputs) {
    hold(inputs);
    lever_elsewhere(inputs);
}

fn engine(speed: Option<i32>) -> impl Fn(&mut Inputs) {
    move |inputs| inputs.engine_speed = speed.map(RevolutionPerMinute)
}

fn is_on(currents: CoilCurrents) -> bool {
    currents != CoilCurrents::OFF
}

/// Steps in a state; true if a coil was on in the last one.
fn is_on_after(rig: &mut Rig, order: Order, steps: usize, state: impl Fn(&mut Inputs)) -> bool {
    let mut passed = CoilCurrents::OFF;
    for _ in 0..steps {
        passed = rig.step_with(order, &state);
    }
    is_on(passed)
}

// REQ-MODE-05
#[test]
fn transport_lock_and_hold_cut_in_the_same_step_and_the_lever_has_to_be_moved_again() {
    for lock in [transport_lock, hold] {
        for order in [LIFT, LOWER] {
            let mut rig = Rig::moving(order);
            assert!(!is_on_after(&mut rig, order, 1, lock), "{order:?}");
            rig.speed = 0;
            for _ in 0..1_000 {
                let passed = rig.step_with(order, |inputs| {
                    lock(inputs);
                    inputs.lever = Some(MilliDegree(60_000));
                });
                assert_eq!(passed, CoilCurrents::OFF, "moved while it was locked");
            }
            assert!(!is_on_after(&mut rig, order, 1_000, open), "opened");
            assert!(is_on_after(&mut rig, order, 1, lever_elsewhere), "moved");
            assert_eq!(rig.envelope.tripped(), None);
        }
    }
}

#[test]
fn the_button_moves_a_hitch_that_is_held() {
    let mut rig = Rig::new();
    assert!(!is_on_after(&mut rig, LIFT, 100, hold));
    assert!(is_on_after(&mut rig, LIFT, 10, held_and_pressed));
}

#[test]
fn no_button_moves_a_hitch_that_is_locked_for_transport() {
    let mut rig = Rig::new();
    assert!(!is_on_after(&mut rig, LIFT, 100, transport_lock));
    assert!(!is_on_after(&mut rig, LIFT, 100, locked_and_pressed));
    assert!(!is_on_after(&mut rig, LIFT, 100, pressed), "since the lock");
    assert!(!is_on_after(&mut rig, LIFT, 20, open), "released");
    assert!(is_on_after(&mut rig, LIFT, 1, pressed));
}

#[test]
fn hold_keeps_what_the_button_moves() {
    let mut rig = Rig::armed();
    rig.speed = FULL_SPEED;
    assert!(is_on_after(&mut rig, LIFT, 10, open), "by the lever");
    assert!(is_on_after(&mut rig, LIFT, 10, pressed), "by both");
    assert!(is_on_after(&mut rig, LIFT, 10, held_and_pressed));
}

#[test]
fn the_button_arms_until_the_hitch_has_stopped_after_its_release() {
    let mut rig = Rig::new();
    rig.run(Order::Rest, 20);
    rig.speed = FULL_SPEED;
    assert!(is_on_after(&mut rig, LIFT, 20, pressed));
    assert!(is_on_after(&mut rig, LIFT, 20, open), "its ramp ends");
    rig.speed = 0;
    assert!(!is_on_after(&mut rig, Order::Rest, 1, lever_elsewhere));
    assert!(
        !is_on_after(&mut rig, LIFT, 100, lever_elsewhere),
        "the same lever"
    );
    assert!(is_on_after(&mut rig, LIFT, 1, open), "moved since");
}

#[test]
fn a_button_that_waits_between_two_moves_stays_armed() {
    let mut rig = Rig::new();
    rig.run(Order::Rest, 20);
    assert!(!is_on_after(&mut rig, Order::Rest, 100, pressed));
    assert!(is_on_after(&mut rig, LIFT, 1, pressed));
    assert!(!is_on_after(&mut rig, Order::Rest, 100, pressed));
    assert!(is_on_after(&mut rig, LIFT, 1, pressed));
}

#[test]
fn the_button_takes_the_lever_s_arming_with_it() {
    let mut rig = Rig::armed();
    rig.speed = FULL_SPEED;
    assert!(is_on_after(&mut rig, LIFT, 20, pressed));
    rig.speed = 0;
    assert!(!is_on_after(&mut rig, Order::Rest, 2, open));
    assert!(!is_on_after(&mut rig, LIFT, 1_000, open), "nobody moved it");
    assert!(is_on_after(&mut rig, LIFT, 1, lever_elsewhere));
}

#[test]
fn a_lever_that_was_moved_under_hold_arms_from_where_hold_ended() {
    let mut rig = Rig::armed();
    assert!(!is_on_after(
        &mut rig,
        LIFT,
        10,
        held_with_the_lever_elsewhere
    ));
    assert!(!is_on_after(&mut rig, LIFT, 10, lever_elsewhere));
    assert!(is_on_after(&mut rig, LIFT, 1, open), "moved since");
}

// REQ-MODE-06
#[test]
fn a_stopped_engine_cuts_at_once_and_disarms() {
    for stopped in [Some(400), Some(0), None] {
        let mut rig = Rig::armed();
        let settling = LOCK.engine_settling.0 as usize;
        is_on_after(&mut rig, Order::Rest, settling, engine(Some(800)));
        let moved = |inputs: &mut Inputs| {
            engine(Some(401))(inputs);
            lever_elsewhere(inputs);
        };
        assert!(is_on_after(&mut rig, LIFT, 1, moved), "runs");
        assert!(
            !is_on_after(&mut rig, LIFT, 1, engine(stopped)),
            "{stopped:?}"
        );
        assert!(!is_on_after(&mut rig, LIFT, 2_000, engine(Some(800))));
        assert!(
            is_on_after(&mut rig, LIFT, 1, moved),
            "nobody moved the lever before"
        );
    }
}

// REQ-MODE-06
#[test]
fn an_engine_that_comes_up_has_to_settle() {
    let settling = LOCK.engine_settling.0 as usize;
    let trembling = |inputs: &mut Inputs| {
        engine(Some(800))(inputs);
        pressed(inputs);
    };
    for (steps, moves) in [(settling - 2, false), (settling - 1, true)] {
        let mut rig = Rig::new();
        is_on_after(&mut rig, Order::Rest, 10, engine(Some(400)));
        is_on_after(&mut rig, Order::Rest, steps, engine(Some(800)));
        // The button has to be seen released after the lock.
        is_on_after(&mut rig, Order::Rest, 20, engine(Some(800)));
        assert_eq!(is_on_after(&mut rig, LIFT, 1, trembling), moves, "{steps}");
    }
}

// REQ-MODE-06
#[test]
fn an_engine_that_is_required_has_to_be_heard() {
    let lock = LockParameters {
        engine_required: Count(1),
        engine_settling: hitch_quantities::units::Millisecond(0),
        ..LOCK
    };
    let limits = Limits {
        lock: &lock,
        ..limits()
    };
    let mut rig = Rig::new();
    let mut step = |lever: i32, speed: Option<i32>| {
        is_on(rig.step_within(limits, LIFT, |inputs| {
            engine(speed)(inputs);
            inputs.lever = Some(MilliDegree(lever));
        }))
    };
    assert!(!step(90_000, None) && !step(95_000, None));
    assert!(!step(95_000, Some(400)) && !step(90_000, Some(400)));
    assert!(!step(90_000, Some(401)));
    assert!(step(95_000, Some(401)));
}

// REQ-MODE-06
#[test]
fn another_calibration_forgets_neither_the_engine_nor_a_final_trip() {
    let mut rig = Rig::armed();
    is_on_after(&mut rig, Order::Rest, 1_000, engine(Some(800)));
    rig.envelope.restart();
    assert!(!is_on_after(&mut rig, LIFT, 10, lever_elsewhere));
    assert!(!is_on_after(&mut rig, LIFT, 10, open), "a silent engine");
    let mut rig = Rig::armed();
    rig.envelope.restart();
    assert!(!is_on_after(&mut rig, LIFT, 100, open), "nobody touched it");
    assert!(is_on_after(&mut rig, LIFT, 1, lever_elsewhere));
    let mut rig = Rig::moving(LIFT);
    rig.cut_after(LIFT, |inputs, _| inputs.lever = None);
    rig.envelope.restart();
    assert_eq!(rig.envelope.tripped(), None);
    let mut rig = Rig::moving(LIFT);
    rig.cut_after(LIFT, |inputs, _| inputs.enable_line_fault = true);
    rig.envelope.restart();
    assert_eq!(rig.envelope.tripped(), Some(Trip::EnableLine));
}

// REQ-MODE-01
#[test]
fn a_fault_of_control_disarms() {
    let mut rig = Rig::armed();
    assert!(is_on_after(&mut rig, LIFT, 10, open));
    rig.envelope.disarm();
    assert!(!is_on_after(&mut rig, LIFT, 1_000, open));
    assert!(is_on_after(&mut rig, LIFT, 1, lever_elsewhere));
}

#[test]
fn a_reset_that_is_asked_for_in_every_step_waits_for_the_time_of_health() {
    let mut rig = Rig::moving(LIFT);
    rig.cut_after(LIFT, |inputs, _| inputs.lever = None);
    rig.speed = 0;
    let cleared = (1..2_000).find(|_| {
        rig.run(Order::Rest, 1);
        rig.envelope.reset();
        rig.envelope.tripped().is_none()
    });
    // The row has held for 5 ms, each of which takes two to forget.
    let forgotten = 2 * SAFETY.sensor_time.0;
    assert_eq!(cleared, Some(forgotten + LOCK.healthy_time.0 - 1));
}

/// Steps until the envelope holds a current back, or trips, on a hitch that stands still.
fn stands_for(contacts: State, press: bool, order: Order) -> Option<i32> {
    let mut rig = Rig::armed();
    rig.run(Order::Rest, 100);
    (1..1_000).find(|_| {
        rig.step_with(order, |inputs| {
            contacts(inputs);
            if press {
                pressed(inputs);
            }
        });
        rig.envelope.holds_back() || rig.envelope.tripped().is_some()
    })
}

#[test]
fn only_service_contact_and_button_together_let_a_hitch_stand_before_it_starts() {
    let service = |inputs: &mut Inputs| {
        inputs.switches = Switches {
            teach: true,
            ..Switches::default()
        };
    };
    for order in [LIFT, LOWER] {
        assert!(stands_for(open, false, order).is_some());
        assert!(stands_for(open, true, order).is_some());
        assert!(stands_for(service, false, order).is_some());
        assert_eq!(stands_for(service, true, order), None, "{order:?}");
    }
}

#[test]
fn a_button_that_was_never_released_is_no_teaching() {
    let mut rig = Rig::new();
    let stuck = |inputs: &mut Inputs| {
        pressed(inputs);
        inputs.switches.teach = true;
    };
    is_on_after(&mut rig, Order::Rest, 100, stuck);
    let by_lever = |inputs: &mut Inputs| {
        stuck(inputs);
        lever_elsewhere(inputs);
    };
    assert!(is_on_after(&mut rig, LIFT, 10, by_lever));
    let held_back = (0..1_000).any(|_| {
        rig.step_with(LIFT, by_lever);
        rig.envelope.holds_back() || rig.envelope.tripped().is_some()
    });
    assert!(held_back, "the thresholds are those of the calibration");
}
