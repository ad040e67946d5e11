//! A control part that doesn't deliver: the envelope cuts what it doesn't hear of.

use hitch_controller::Controller;
use hitch_quantities::calibration::design_parameters::SafetyParameters;
use hitch_quantities::units::{Duty, MilliDegree, MilliVolt};
use hitch_quantities::{Calibration, Fault, Inputs, Outputs, State, Trip};

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
    for step in 1..SafetyParameters::NOMINAL.command_age.0 {
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
