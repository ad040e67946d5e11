//! What holds without any row: trips and faults, arming, slopes and limits.

use super::*;

#[test]
fn a_worse_trip_replaces_the_first_and_no_other_does() {
    let mut rig = Rig::moving(LIFT);
    rig.cut_after(LIFT, |inputs, _| inputs.lever = None);
    rig.cut_after(LIFT, |inputs, _| inputs.supply = Some(MilliVolt(0)));
    (0..30).for_each(|_| {
        rig.step_with(LIFT, |inputs| inputs.supply = Some(MilliVolt(0)));
    });
    assert_eq!(rig.envelope.tripped(), Some(Trip::Lever));
    for _ in 0..100 {
        rig.step_with(LIFT, |inputs| inputs.lower_current = Some(MilliAmp(1_000)));
    }
    assert_eq!(rig.envelope.tripped(), Some(Trip::CoilStuck));
    for _ in 0..100 {
        rig.step_with(LIFT, |inputs| inputs.lever = None);
    }
    assert_eq!(rig.envelope.tripped(), Some(Trip::CoilStuck));
}

#[test]
fn a_trip_that_holds_does_not_hide_a_final_one() {
    let mut rig = Rig::moving(LIFT);
    rig.cut_after(LIFT, |inputs, _| inputs.lever = None);
    for _ in 0..100 {
        rig.step_with(LIFT, |inputs| {
            (inputs.lever, inputs.lower_current) = (None, Some(MilliAmp(1_000)));
        });
    }
    assert_eq!(rig.envelope.tripped(), Some(Trip::CoilStuck));
}

#[test]
fn every_trip_is_reported_as_a_fault_of_its_kind() {
    let faults = Trip::ALL.map(Trip::fault);
    assert_eq!(
        faults,
        [
            Fault::Envelope,
            Fault::Envelope,
            Fault::Overrun,
            Fault::Supply,
            Fault::Lever,
            Fault::Angle,
            Fault::Angle,
            Fault::Angle,
            Fault::Angle,
            Fault::NotFollowing,
            Fault::Envelope,
            Fault::Coil,
            Fault::Coil,
            Fault::Coil,
            Fault::Reference,
            Fault::SensorSupply,
            Fault::Angle,
            Fault::Overrun,
            Fault::EnableLine,
            Fault::Memory,
            Fault::Envelope,
            Fault::Envelope,
            Fault::Envelope,
        ]
    );
    assert_eq!(
        Trip::ALL.map(|trip| trip as usize),
        [
            1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23
        ]
    );
}

// REQ-MODE-01
#[test]
fn nothing_passes_until_lever_or_button_is_touched() {
    let mut rig = Rig::new();
    assert_eq!(rig.run(LIFT, 5_000), CoilCurrents::OFF);
    let with_lever = |rig: &mut Rig, lever: i32| {
        rig.step_with(LIFT, |inputs| inputs.lever = Some(MilliDegree(lever)))
    };
    assert_eq!(with_lever(&mut rig, 90_349), CoilCurrents::OFF, "noise");
    assert_eq!(with_lever(&mut rig, 89_651), CoilCurrents::OFF, "noise");
    assert_ne!(with_lever(&mut rig, 89_650), CoilCurrents::OFF);
    assert_ne!(rig.run(LIFT, 100), CoilCurrents::OFF, "once is enough");
    let mut rig = Rig::new();
    let pressed = |inputs: &mut Inputs| inputs.jog = Some(MilliDegreePerSecond(1));
    for _ in 0..100 {
        assert_eq!(
            rig.step_with(LIFT, pressed),
            CoilCurrents::OFF,
            "pressed since power-up"
        );
    }
    assert_eq!(rig.run(LIFT, 20), CoilCurrents::OFF, "released");
    assert_ne!(rig.step_with(LIFT, pressed), CoilCurrents::OFF);
}

// REQ-SAFE-01
#[test]
fn currents_rise_along_the_slope_and_fall_at_once() {
    for (full, way) in [(Order::Lift(3_500), 1), (Order::Lower(3_500), -1)] {
        let mut rig = Rig::armed();
        rig.speed = way * FULL_SPEED;
        let sum = |passed: CoilCurrents| passed.lift.0 + passed.lower.0;
        let rise: Vec<i32> = (0..60).map(|_| sum(rig.run(full, 1))).collect();
        assert_eq!(rise[..3], [1_540, 1_580, 1_620]);
        assert_eq!(rise[59], 3_500);
        assert_eq!(rig.run(Order::Rest, 1), CoilCurrents::OFF);
    }
}

// REQ-SAFE-01
#[test]
fn limits_bound_each_coil_by_its_own() {
    let safety = SafetyParameters {
        lift_current_limit: MilliAmp(1_000),
        lower_current_limit: MilliAmp(900),
        ..SAFETY
    };
    let limits = Limits {
        safety: &safety,
        sensors: &SENSORS,
        ..limits()
    };
    for (order, most) in [
        (Order::Lift(i32::MAX), (1_000, 0)),
        (Order::Lower(i32::MAX), (0, 900)),
        (Order::Lift(i32::MIN), (0, 0)),
    ] {
        let mut rig = Rig::armed();
        let inputs = rig.inputs();
        let passed = pass(&mut rig.envelope, Some(order.currents()), &inputs, limits);
        assert_eq!((passed.lift.0, passed.lower.0), most);
    }
}

// REQ-MODE-07
#[test]
fn a_change_of_coil_takes_a_step_with_both_off() {
    for (one, other) in [(LIFT, LOWER), (LOWER, LIFT)] {
        let mut rig = Rig::armed();
        assert_ne!(rig.run(one, 3), CoilCurrents::OFF);
        assert_eq!(rig.run(other, 1), CoilCurrents::OFF);
        assert_ne!(rig.run(other, 1), CoilCurrents::OFF);
    }
}
