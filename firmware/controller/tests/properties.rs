//! What holds whatever the controller is told.

use hitch_controller::Controller;
use hitch_quantities::signals::INPUT_BYTES;
use hitch_quantities::units::{MilliAmp, MilliBar, MilliDegree, MilliDegreePerSecond};
use hitch_quantities::{Calibration, Inputs, Outputs, State};
use proptest::prelude::*;

fn controller() -> Controller {
    Controller::new(
        Calibration::nominal()
            .validate()
            .expect("the nominal calibration is valid"),
    )
}

/// A value of the range that matters, or anything, or nothing.
fn reading(low: i32, high: i32) -> impl Strategy<Value = Option<i32>> {
    prop_oneof![
        8 => (low..=high).prop_map(Some),
        1 => any::<i32>().prop_map(Some),
        1 => Just(None),
    ]
}

/// Inputs that stay for a while.
fn segment() -> impl Strategy<Value = (Inputs, usize)> {
    let readings = (
        reading(40_000, 140_000),
        prop_oneof![4 => Just(None), 1 => reading(-30_000, 30_000)],
        reading(40_000, 140_000),
        reading(0, 160_000),
        reading(0, 160_000),
    );
    (readings, 1usize..400).prop_map(|((lever, jog, angle, cylinder, pump), steps)| {
        let inputs = Inputs {
            lever: lever.map(MilliDegree),
            jog: jog.map(MilliDegreePerSecond),
            rocker_angle: angle.map(MilliDegree),
            cylinder_pressure: cylinder.map(MilliBar),
            pump_pressure: pump.map(MilliBar),
            ..Inputs::default()
        };
        (inputs, steps)
    })
}

/// A hitch of sorts: turns towards wherever the coils push it, so that moves have a course and arrive.
fn moved(angle: MilliDegree, outputs: &Outputs) -> MilliDegree {
    let up = (outputs.lift_current.0 - 1_126).max(0) / 25;
    let down = (outputs.lower_current.0 - 999).max(0) / 15;
    MilliDegree((angle.0 + up - down).clamp(44_100, 135_900))
}

fn check(outputs: &Outputs) -> Result<(), TestCaseError> {
    let (lift, lower) = (outputs.lift_current, outputs.lower_current);
    prop_assert!(
        lift == MilliAmp(0) || lower == MilliAmp(0),
        "both coils: {outputs:?}"
    );
    for current in [lift, lower] {
        prop_assert!(
            (MilliAmp(0)..=MilliAmp(3_500)).contains(&current),
            "{outputs:?}"
        );
    }
    let on = lift > MilliAmp(0) || lower > MilliAmp(0);
    let may_move = matches!(
        outputs.state,
        State::Lifting | State::Lowering | State::Teaching
    );
    prop_assert!(!on || may_move, "current without a move: {outputs:?}");
    prop_assert!(
        outputs.fault.is_none() || !on,
        "current with a fault: {outputs:?}"
    );
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    // REQ-SAFE-01
    #[test]
    fn never_both_coils_and_never_a_current_out_of_state(segments in prop::collection::vec(segment(), 1..12)) {
        let mut controller = controller();
        for (inputs, steps) in segments {
            for _ in 0..steps {
                check(&controller.step(&inputs))?;
            }
        }
    }

    #[test]
    fn a_hitch_that_answers_is_moved_by_one_coil_at_a_time(
        levers in prop::collection::vec((44_000i32..136_000, 1usize..1_500), 1..8),
        start in 45_000i32..135_000,
    ) {
        let mut controller = controller();
        let mut angle = MilliDegree(start);
        let mut last = (MilliAmp(0), MilliAmp(0));
        for (lever, steps) in levers {
            for _ in 0..steps {
                let inputs = Inputs { lever: Some(MilliDegree(lever)), rocker_angle: Some(angle), ..Inputs::default() };
                let outputs = controller.step(&inputs);
                check(&outputs)?;
                let reversed = (last.0 > MilliAmp(0) && outputs.lower_current > MilliAmp(0))
                    || (last.1 > MilliAmp(0) && outputs.lift_current > MilliAmp(0));
                prop_assert!(!reversed, "no dwell between {last:?} and {outputs:?}");
                last = (outputs.lift_current, outputs.lower_current);
                angle = moved(angle, &outputs);
            }
        }
    }

    // REQ-MODE-01
    #[test]
    fn locked_means_still(lever in 40_000i32..140_000, angle in 45_000i32..135_000, steps in 1usize..3_000) {
        let mut controller = controller();
        let inputs = Inputs { lever: Some(MilliDegree(lever)), rocker_angle: Some(MilliDegree(angle)), ..Inputs::default() };
        for _ in 0..steps {
            let outputs = controller.step(&inputs);
            prop_assert_eq!(outputs.state, State::Locked);
            prop_assert_eq!((outputs.lift_current, outputs.lower_current), (MilliAmp(0), MilliAmp(0)));
        }
    }

    // REQ-SAFE-12
    #[test]
    fn any_image_is_survived(images in prop::collection::vec(any::<[u8; INPUT_BYTES]>(), 1..200)) {
        let mut controller = controller();
        for image in &images {
            check(&controller.step(&Inputs::from_bytes(image)))?;
        }
    }

    // REQ-MOTION-07
    #[test]
    fn the_same_inputs_give_the_same_outputs(segments in prop::collection::vec(segment(), 1..6)) {
        let (mut one, mut other) = (controller(), controller());
        for (inputs, steps) in segments {
            for _ in 0..steps {
                prop_assert_eq!(one.step(&inputs).to_bytes(), other.step(&inputs).to_bytes());
            }
        }
    }
}
