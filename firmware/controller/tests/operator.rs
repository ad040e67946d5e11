//! Modes and what the operator sets besides the lever.

use hitch_controller::Controller;
use hitch_quantities::units::{
    MilliAmp, MilliDegree, MilliDegreePerSecond, PerMille, RevolutionPerMinute,
};
use hitch_quantities::{Calibration, Inputs, Outputs, State, Switches};

/// A hitch in integers that follows its coils like a valve without lag.
struct Hitch {
    controller: Controller,
    angle_micro: i64,
    inputs: Inputs,
}

impl Hitch {
    fn locked(angle: i32) -> Self {
        let calibration = Calibration::nominal().validate().expect("nominal");
        Self {
            controller: Controller::new(calibration),
            angle_micro: i64::from(angle) * 1_000,
            inputs: Inputs {
                lever: Some(MilliDegree(angle - 2_000)),
                ..Inputs::default()
            },
        }
    }

    /// Picked up with the lever at `angle`, resting.
    fn picked_up(angle: i32) -> Self {
        let mut hitch = Self::locked(angle);
        hitch.run(10);
        hitch.inputs.lever = Some(MilliDegree(angle));
        assert_eq!(hitch.run(300).state, State::Holding);
        hitch
    }

    fn run(&mut self, steps: usize) -> Outputs {
        (0..steps)
            .map(|_| {
                self.inputs.rocker_angle = Some(MilliDegree((self.angle_micro / 1_000) as i32));
                let outputs = self.controller.step(&self.inputs);
                let up = i64::from((outputs.lift_current.0 - 1_126).max(0)) * 40;
                let down = i64::from((outputs.lower_current.0 - 999).max(0)) * 40;
                self.angle_micro = (self.angle_micro + up - down).clamp(44_100_000, 135_900_000);
                outputs
            })
            .last()
            .unwrap_or_default()
    }

    /// Runs; true if no coil is ever on.
    fn is_still(&mut self, steps: usize) -> bool {
        (0..steps).all(|_| {
            let outputs = self.run(1);
            outputs.lift_current == MilliAmp(0) && outputs.lower_current == MilliAmp(0)
        })
    }

    fn lever(&mut self, angle: i32) {
        self.inputs.lever = Some(MilliDegree(angle));
    }

    fn is_at(&self, angle: i32) -> bool {
        (self.angle_micro / 1_000 - i64::from(angle)).abs() < 360
    }
}

// REQ-MODE-05
#[test]
fn transport_lock_stops_at_once_and_has_to_be_picked_up_again() {
    let mut hitch = Hitch::picked_up(90_000);
    hitch.lever(120_000);
    assert_eq!(hitch.run(200).state, State::Lifting);
    hitch.inputs.switches.transport_lock = true;
    assert!(hitch.is_still(1_000), "stops in the very step");
    assert_eq!(hitch.run(1).state, State::TransportLock);
    hitch.inputs.jog = Some(MilliDegreePerSecond(5_000));
    assert!(hitch.is_still(1_000), "the button is locked too");
    hitch.inputs.jog = None;
    hitch.inputs.switches.transport_lock = false;
    assert!(hitch.is_still(2_000), "nobody picked it up");
    assert_eq!(hitch.run(1).state, State::Locked);
    hitch.lever(80_000);
    hitch.run(3_000);
    assert!(hitch.is_at(80_000));
}

// REQ-MODE-05
#[test]
fn hold_keeps_the_hitch_whatever_the_lever_does() {
    let mut hitch = Hitch::picked_up(90_000);
    hitch.inputs.switches.hold = true;
    hitch.run(1);
    for lever in [120_000, 50_000, 90_000, 130_000] {
        hitch.lever(lever);
        assert!(hitch.is_still(1_000), "{lever}");
    }
    assert_eq!(hitch.run(1).state, State::Holding);
    hitch.inputs.switches.hold = false;
    assert!(hitch.is_still(2_000), "jumps to where the lever is");
    hitch.lever(60_000);
    hitch.run(4_000);
    assert!(hitch.is_at(60_000), "picked up by passing the hitch");
}

// REQ-MODE-05
#[test]
fn hold_stops_a_moving_hitch_at_once() {
    let mut hitch = Hitch::picked_up(90_000);
    hitch.lever(120_000);
    assert_eq!(hitch.run(200).state, State::Lifting);
    hitch.inputs.switches.hold = true;
    assert!(hitch.is_still(1_000), "stops in the very step");
    assert_eq!(hitch.run(1).state, State::Holding);
    hitch.inputs.jog = Some(MilliDegreePerSecond(-5_000));
    assert_eq!(hitch.run(300).state, State::Lowering, "the button lowers");
    hitch.inputs.jog = None;
    hitch.run(1_000);
    assert!(hitch.is_still(1_000), "released");
}

// REQ-MODE-05
// REQ-MODE-06
#[test]
fn a_button_that_is_pressed_while_a_lock_opens_moves_nothing() {
    let transport_lock = |inputs: &mut Inputs, locked| inputs.switches.transport_lock = locked;
    let engine = |inputs: &mut Inputs, locked| {
        let speed = if locked { 0 } else { 800 };
        inputs.engine_speed = Some(RevolutionPerMinute(speed));
    };
    let locks: [fn(&mut Inputs, bool); 2] = [transport_lock, engine];
    for lock in locks {
        let mut hitch = Hitch::locked(90_000);
        hitch.run(20);
        lock(&mut hitch.inputs, true);
        hitch.inputs.jog = Some(MilliDegreePerSecond(5_000));
        assert!(hitch.is_still(1_000));
        lock(&mut hitch.inputs, false);
        assert!(hitch.is_still(2_000), "still pressed");
        assert_eq!(hitch.run(1).state, State::Locked);
        hitch.inputs.jog = None;
        hitch.run(20);
        hitch.inputs.jog = Some(MilliDegreePerSecond(5_000));
        assert_eq!(hitch.run(100).state, State::Lifting);
    }
}

// REQ-SAFE-10
// REQ-SAFE-13
#[test]
fn a_dial_that_is_turned_below_a_moving_hitch_or_shut_stops_it_before_its_row_trips() {
    let upper_limit = |inputs: &mut Inputs| inputs.upper_limit = Some(MilliDegree(60_000));
    let shut = |inputs: &mut Inputs| inputs.lowering_dial = Some(PerMille(0));
    let dials: [fn(&mut Inputs); 2] = [upper_limit, shut];
    for (lever, dial) in [130_000, 50_000].into_iter().zip(dials) {
        let mut hitch = Hitch::picked_up(90_000);
        hitch.lever(lever);
        hitch.run(300);
        dial(&mut hitch.inputs);
        for _ in 0..1_000 {
            assert_eq!(hitch.run(1).trip, None, "lever at {lever}");
        }
    }
}

// REQ-MODE-04
#[test]
fn the_upper_limit_caps_lever_and_button() {
    let mut hitch = Hitch::picked_up(90_000);
    hitch.inputs.upper_limit = Some(MilliDegree(110_000));
    hitch.lever(130_000);
    let outputs = hitch.run(4_000);
    assert_eq!(outputs.target, MilliDegree(110_000));
    assert!(hitch.is_at(110_000));
    hitch.inputs.jog = Some(MilliDegreePerSecond(15_000));
    hitch.run(3_000);
    assert!(hitch.angle_micro < 110_500_000, "{}", hitch.angle_micro);
    for absurd in [i32::MIN, i32::MAX] {
        hitch.inputs.upper_limit = Some(MilliDegree(absurd));
        hitch.run(100);
    }
}

// REQ-MODE-04
#[test]
fn a_shut_dial_lowers_nothing_and_still_lifts() {
    let mut hitch = Hitch::picked_up(90_000);
    hitch.inputs.lowering_dial = Some(PerMille(100));
    hitch.lever(60_000);
    assert!(hitch.is_still(2_000));
    hitch.lever(100_000);
    hitch.run(3_000);
    assert!(hitch.is_at(100_000));
    hitch.inputs.jog = Some(MilliDegreePerSecond(-15_000));
    assert!(hitch.is_still(1_000), "the button lowers");
}

// REQ-MODE-10
#[test]
fn quick_lift_raises_and_returns_to_the_lever() {
    let mut hitch = Hitch::picked_up(90_000);
    let press = |hitch: &mut Hitch| {
        hitch.inputs.switches.quick_lift = true;
        hitch.run(100);
        hitch.inputs.switches.quick_lift = false;
        hitch.run(4_000)
    };
    assert_eq!(press(&mut hitch).state, State::Holding);
    assert!(hitch.is_at(124_900), "{}", hitch.angle_micro);
    press(&mut hitch);
    assert!(hitch.is_at(90_000), "{}", hitch.angle_micro);
    press(&mut hitch);
    hitch.inputs.switches.transport_lock = true;
    hitch.run(10);
    hitch.inputs.switches.transport_lock = false;
    assert_eq!(
        press(&mut hitch).state,
        State::Locked,
        "no button opens the lock"
    );
    assert!(hitch.is_at(124_900));
}

// REQ-MODE-10
#[test]
fn a_floating_hitch_may_settle_and_is_nobodys_fault() {
    let mut hitch = Hitch::picked_up(60_000);
    hitch.lever(44_600);
    hitch.run(3_000);
    assert_eq!(hitch.run(1_000).state, State::Floating);
    for _ in 0..20 {
        hitch.angle_micro += 100_000;
        assert!(hitch.is_still(2_000), "works against the ground");
    }
    assert_eq!(hitch.run(1).fault, None);
    hitch.lever(50_000);
    assert!(hitch.is_still(199), "a knocked lever");
    hitch.run(2_000);
    assert!(hitch.is_at(50_000), "{}", hitch.angle_micro);
}

// REQ-MODE-06
#[test]
fn a_stalled_engine_locks_the_hitch() {
    let mut hitch = Hitch::picked_up(90_000);
    hitch.inputs.engine_speed = Some(RevolutionPerMinute(300));
    hitch.lever(120_000);
    assert!(hitch.is_still(2_000));
    hitch.inputs.engine_speed = Some(RevolutionPerMinute(850));
    assert!(hitch.is_still(2_000), "nobody picked it up");
    hitch.lever(70_000);
    hitch.run(4_000);
    assert!(hitch.is_at(70_000));
}

// REQ-MODE-01
#[test]
fn a_button_pressed_at_power_up_or_through_a_fault_moves_nothing() {
    let mut hitch = Hitch::locked(90_000);
    hitch.inputs.jog = Some(MilliDegreePerSecond(10_000));
    assert!(hitch.is_still(2_000));
    hitch.inputs.jog = None;
    hitch.run(20);
    hitch.inputs.jog = Some(MilliDegreePerSecond(10_000));
    assert_eq!(hitch.run(100).state, State::Lifting);
    let lever = hitch.inputs.lever.take();
    assert_eq!(hitch.run(20).state, State::Fault);
    hitch.inputs.lever = lever;
    assert!(hitch.is_still(2_000), "still pressed after the fault");
}

#[test]
fn every_switch_at_once_moves_nothing() {
    let mut hitch = Hitch::picked_up(90_000);
    hitch.inputs.switches = Switches {
        transport_lock: true,
        hold: true,
        quick_lift: true,
        teach: true,
        ..Switches::default()
    };
    hitch.inputs.jog = Some(MilliDegreePerSecond(10_000));
    hitch.lever(120_000);
    assert!(hitch.is_still(2_000));
}
