//! The last act: pulse widths, only of currents that passed in the same step; and a control part that doesn't deliver.

use hitch_firmware::control::current::Duties;
use hitch_firmware::control::units::Duty;
use hitch_firmware::control::{Calibration, Controller, Outputs, State};

use super::*;

const WIDTHS: Duties = Duties {
    lift: Duty(30_000),
    lower: Duty(40_000),
};

#[test]
fn a_width_is_released_for_a_coil_with_a_current_and_once() {
    for (order, lift, lower) in [
        (LIFT, WIDTHS.lift, Duty::ZERO),
        (LOWER, Duty::ZERO, WIDTHS.lower),
        (Order::Rest, Duty::ZERO, Duty::ZERO),
    ] {
        let mut rig = Rig::armed();
        rig.run(order, 1);
        assert_eq!(rig.envelope.release(WIDTHS), Duties { lift, lower });
        let again = rig.envelope.release(WIDTHS);
        assert_eq!(again, Duties::default(), "without a step in between");
    }
}

#[test]
fn a_width_is_a_share_of_the_whole() {
    let mut rig = Rig::armed();
    for (width, released) in [(i32::MAX, 100_000), (i32::MIN, 0), (1, 1)] {
        rig.run(LIFT, 1);
        let widths = Duties {
            lift: Duty(width),
            ..WIDTHS
        };
        assert_eq!(rig.envelope.release(widths).lift, Duty(released));
    }
}

#[test]
fn no_width_is_released_unarmed_tripped_or_stale() {
    let mut unarmed = Rig::new();
    unarmed.run(LIFT, 10);
    assert_eq!(unarmed.envelope.release(WIDTHS), Duties::default());
    let mut tripped = Rig::moving(LIFT);
    tripped.cut_after(LIFT, |inputs, _| inputs.lever = None);
    assert_eq!(tripped.envelope.release(WIDTHS), Duties::default());
    let mut stale = Rig::moving(LIFT);
    let inputs = stale.inputs();
    let command = Command {
        currents: LIFT.currents(),
        step: stale.envelope.step(),
    };
    stale.envelope.pass(command, &inputs, limits());
    assert_eq!(stale.envelope.release(WIDTHS).lift, WIDTHS.lift);
    stale.envelope.pass(command, &inputs, limits());
    assert_eq!(stale.envelope.release(WIDTHS), Duties::default());
    assert_eq!(stale.envelope.tripped(), None, "not yet");
}

#[test]
fn no_coil_is_switched_on_while_a_sample_is_bridged() {
    let faults: [fn(&mut Inputs); 3] = [
        |inputs| inputs.rocker_angle = None,
        |inputs| inputs.lever = None,
        |inputs| inputs.rocker_angle = inputs.rocker_angle.map(|angle| angle + MilliDegree(5_000)),
    ];
    for fault in faults {
        for order in [LIFT, LOWER] {
            let mut rig = Rig::armed();
            for _ in 0..3 {
                assert_eq!(rig.step_with(order, fault), CoilCurrents::OFF);
            }
            assert_ne!(rig.run(order, 1), CoilCurrents::OFF, "the sample is back");
            for _ in 0..2 {
                assert_ne!(rig.step_with(order, fault), CoilCurrents::OFF, "stays on");
            }
        }
    }
}

/// A controller that has just begun to lift.
fn lifting() -> (Controller, Inputs) {
    let mut controller = Controller::new(Calibration::nominal().validate().unwrap());
    let stays = std::iter::repeat_n(110_000, 1_000);
    for lever in (70_000..=110_000).step_by(500).chain(stays) {
        let inputs = Inputs {
            lever: Some(MilliDegree(lever)),
            rocker_angle: Some(MilliDegree(80_000)),
            supply: Some(MilliVolt(13_500)),
            ..Inputs::default()
        };
        let outputs = controller.step(&inputs);
        if outputs.state == State::Lifting && outputs.lift_duty > Duty::ZERO {
            return (controller, inputs);
        }
    }
    panic!("it doesn't lift");
}

fn widths(outputs: &Outputs) -> (Duty, Duty) {
    (outputs.lift_duty, outputs.lower_duty)
}

#[test]
fn a_control_part_that_does_not_deliver_cuts_at_once_and_trips() {
    let (mut controller, inputs) = lifting();
    for step in 1..SAFETY.command_age.0 {
        let outputs = controller.protect(&inputs);
        assert_eq!(widths(&outputs), (Duty::ZERO, Duty::ZERO), "step {step}");
        assert_eq!(outputs.trip, None, "step {step}");
    }
    let outputs = controller.protect(&inputs);
    assert_eq!(outputs.trip, Some(Trip::Stale));
    assert_eq!(outputs.fault, Some(Fault::Envelope));
    for _ in 0..200 {
        assert_eq!(
            widths(&controller.step(&inputs)),
            (Duty::ZERO, Duty::ZERO),
            "until the lever picks the hitch up again"
        );
    }
}

#[test]
fn one_command_that_is_left_out_passes_no_current() {
    let (mut controller, inputs) = lifting();
    assert_ne!(controller.step(&inputs).lift_duty, Duty::ZERO);
    assert_eq!(controller.protect(&inputs).lift_duty, Duty::ZERO);
    let outputs = controller.step(&inputs);
    assert_eq!(outputs.trip, None);
}
