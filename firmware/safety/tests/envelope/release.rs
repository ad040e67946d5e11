//! The last act: pulse widths, only of currents that passed in the same step.

use hitch_quantities::Duties;
use hitch_quantities::units::Duty;

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
