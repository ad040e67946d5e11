//! Tests: a bit of the calibration in use flips.

use hitch_quantities::Trip;
use hitch_quantities::calibration::calibration_words::CALIBRATION_WORDS;
use hitch_quantities::units::{MilliAmp, MilliDegree};

use super::*;

/// The longest time until a bit is noticed: the check may just have passed it.
const LONGEST: usize = 2 * CALIBRATION_WORDS;

fn controller() -> Controller {
    Controller::new(Calibration::nominal().validate().unwrap())
}

/// Steps at rest until a trip; how many.
fn tripped_after(controller: &mut Controller) -> Option<usize> {
    let inputs = Inputs {
        lever: Some(MilliDegree(100_000)),
        rocker_angle: Some(MilliDegree(90_000)),
        ..Inputs::default()
    };
    (0..=LONGEST).find(|_| controller.step(&inputs).trip == Some(Trip::Memory))
}

#[test]
fn every_bit_that_flips_is_noticed_within_a_second() {
    const { assert!(LONGEST <= 1_000) };
    let healthy = controller();
    for word in 0..CALIBRATION_WORDS {
        for bit in [0, 7, 16, 31] {
            let mut controller = healthy.clone();
            controller.control.flip_calibration_bit(word, bit);
            assert!(
                tripped_after(&mut controller).is_some(),
                "word {word}, bit {bit}"
            );
        }
    }
}

#[test]
fn a_healthy_calibration_is_no_fault_however_often_it_is_changed() {
    let mut controller = controller();
    assert_eq!(tripped_after(&mut controller), None);
    for round in 1..100 {
        let mut block = Calibration::nominal();
        block.position.lift_speed.0 -= round;
        controller.recalibrate(block.sealed().validate().unwrap());
        let inputs = Inputs::default();
        for _ in 0..7 * round {
            assert_ne!(controller.step(&inputs).trip, Some(Trip::Memory));
        }
    }
}

#[test]
fn a_flipped_bit_stops_a_moving_hitch_for_good() {
    let mut controller = controller();
    let mut angle = 90_000;
    let mut step = |controller: &mut Controller, lever| -> Outputs {
        let inputs = Inputs {
            lever: Some(MilliDegree(lever)),
            rocker_angle: Some(MilliDegree(angle)),
            ..Inputs::default()
        };
        let outputs = controller.step(&inputs);
        angle += (outputs.lift_current.0 - 1_126).max(0) / 25;
        outputs
    };
    (0..20).for_each(|_| {
        step(&mut controller, 80_000);
    });
    let moved = (0..300).any(|_| step(&mut controller, 130_000).lift_current > MilliAmp::ZERO);
    assert!(moved);
    // Not one that the move depends on.
    controller
        .control
        .flip_calibration_bit(CALIBRATION_WORDS - 1, 3);
    assert!((0..LONGEST).any(|_| step(&mut controller, 130_000).trip == Some(Trip::Memory)));
    let still = |outputs: Outputs| {
        (outputs.lift_current, outputs.lower_current) == (MilliAmp::ZERO, MilliAmp::ZERO)
    };
    // Neither the lever nor another calibration brings it back.
    controller.restart(Calibration::nominal().validate().unwrap());
    for lever in [60_000, 130_000, 60_000] {
        assert!((0..2_000).all(|_| still(step(&mut controller, lever))));
    }
}
