//! The firmware identifies thresholds and ends on plants whose valves and sensors deviate.

use hitch_closed_loop::ClosedLoop;
use hitch_control::commissioning::teach::{Taught, TeachError};
use hitch_plant::Model;
use hitch_quantities::units::MilliDegree;
use hitch_quantities::{Inputs, State};
use hitch_results::closed_loop::{LoopRun, Scenario, run};
use host_tests::seeds::cases;
use host_tests::teaching::{dynamic_with, nominal, teach as taught, teach_with as taught_with};

fn shifted(lift_a: f64, lower_a: f64) -> Model {
    dynamic_with(&[
        ("lift-threshold-shift", &[lift_a]),
        ("lower-threshold-shift", &[lower_a]),
    ])
}

/// As accurate as a machine whose valves match the calibration.
fn assert_as_good(run: &LoopRun, right: &LoopRun) {
    let (summary, right) = (run.summary, right.summary);
    assert!(summary.final_error_max_deg <= 0.3, "{summary:?}");
    assert!(
        summary.overshoot_max_deg <= right.overshoot_max_deg.max(0.3),
        "{summary:?}, not {right:?}"
    );
    assert_eq!(summary.switched_on_after, 0, "{summary:?}");
    // A spool passes a threshold that is 0.25 A higher some 10 ms later: 0.024 of the shortest time of the median lift.
    assert!(
        summary.ratio_median <= right.ratio_median + 0.025,
        "{summary:?}, not {right:?}"
    );
    assert!(
        summary.ratio_p95 <= right.ratio_p95 + 0.05,
        "{summary:?}, not {right:?}"
    );
}

// REQ-MOTION-05
#[test]
fn thresholds_that_are_off_by_a_quarter_ampere_are_found() {
    println!("shifts, A       load   found, A         ends, deg        moves afterwards");
    let shifts_a = [(0.25, -0.25), (-0.25, 0.25), (0.25, 0.25), (-0.25, -0.25)];
    for &(lift_a, lower_a) in cases(&shifts_a[..2], &shifts_a) {
        for &load_kg in cases(&[150.0][..], &[50.0, 150.0, 250.0]) {
            let model = shifted(lift_a, lower_a);
            let found = taught(&model, load_kg).unwrap();
            let [lift_found_a, lower_found_a] =
                [found.lift_shift, found.lower_shift].map(|shift| f64::from(shift.0) * 1e-3);
            // The spool lags have a separate test.
            let hydraulics = &nominal().hydraulics;
            let thresholds_alone = Taught {
                lift_lag: hydraulics.spool_lag,
                lower_lag: hydraulics.lower_spool_lag,
                ..found
            };
            let calibration = thresholds_alone.applied_to(&nominal()).validate().unwrap();
            let right = run(
                &hitch_model_file::dynamic(),
                &nominal(),
                &Scenario::Moves.moves(&model, Some(&[load_kg])),
            )
            .unwrap();
            let moves = run(
                &model,
                &calibration,
                &Scenario::Moves.moves(&model, Some(&[load_kg])),
            )
            .unwrap();
            let [lower_end_deg, upper_end_deg] =
                [found.lower_end, found.upper_end].map(|end| f64::from(end.0) * 1e-3);
            println!(
                "{lift_a:5.2} {lower_a:5.2} {load_kg:8} {lift_found_a:7.3} {lower_found_a:7.3} {lower_end_deg:8.2} {upper_end_deg:7.2} ratio {:.2} {:.2}, overshoot {:.2}",
                moves.summary.ratio_median,
                moves.summary.ratio_p95,
                moves.summary.overshoot_max_deg
            );
            assert!(
                (lift_found_a - lift_a).abs() <= 0.02 && (lower_found_a - lower_a).abs() <= 0.02
            );
            assert!((lower_end_deg - 44.1).abs() <= 0.1 && (upper_end_deg - 135.9).abs() <= 0.1);
            assert_as_good(&moves, &right);
        }
    }
}

// REQ-MOTION-05
/// A current step yields the spool lag, with a load that oscillates on aerated oil and a noisy sensor.
#[test]
fn the_lags_of_the_spools_are_found() {
    let effects = dynamic_with(&[
        ("lift-threshold-shift", &[0.1]),
        ("lower-threshold-shift", &[-0.1]),
        ("solenoid-hysteresis", &[0.12]),
        ("coulomb-friction", &[400.0]),
        ("entrained-air", &[0.02, 1.2]),
    ])
    .effects;
    for &true_ms in cases(&[30.0, 55.0][..], &[30.0, 45.0, 55.0]) {
        let mut constants = hitch_model_file::dynamic().constants().clone();
        constants.spool_time_constant_s = 1e-3 * true_ms;
        let model = Model::new("another spool", constants)
            .unwrap()
            .with_effects(effects.clone());
        for &load_kg in cases(&[50.0, 250.0][..], &[50.0, 150.0, 250.0]) {
            let found = taught(&model, load_kg).unwrap();
            let calibration = found.applied_to(&nominal()).validate().unwrap();
            let hydraulics = &calibration.hydraulics;
            let lags = [hydraulics.spool_lag, hydraulics.lower_spool_lag];
            println!("{load_kg:5} kg, {true_ms:.0} ms: found {lags:?}");
            for lag in lags {
                assert!((f64::from(lag.0) - true_ms).abs() <= 7.0, "{found:?}");
            }
        }
    }
}

/// At the upper end the pump pressure rises to the relief setting, and aerated oil stores volume at that pressure: a light
/// load does not move before the lowering valve has drained it. This must not be identified as the lower end.
#[test]
fn a_light_load_on_aerated_oil_is_given_time_to_leave_the_upper_end() {
    let model = dynamic_with(&[
        ("entrained-air", &[0.05, 1.2]),
        ("coulomb-friction", &[700.0]),
        ("solenoid-hysteresis", &[0.13]),
    ]);
    for load_kg in [50.0, 60.0] {
        let found = taught(&model, load_kg).unwrap();
        assert!(
            (found.lower_end.0 - 44_100).abs() < 200,
            "{found:?} with {load_kg} kg"
        );
    }
}

#[test]
fn a_sensor_that_is_turned_on_its_shaft_moves_linkage_and_limits() {
    let turned = |_, inputs: &mut Inputs| {
        inputs.rocker_angle = inputs.rocker_angle.map(|angle| angle + MilliDegree(2_000))
    };
    let found = taught_with(&hitch_model_file::dynamic(), 150.0, 120_000, turned)
        .unwrap()
        .unwrap();
    let calibration = found.applied_to(&nominal());
    assert!(
        (calibration.linkage.first_angle.0 - 46_000).abs() <= 100,
        "{:?}",
        calibration.linkage.first_angle
    );
    assert!((calibration.position.lower_limit.0 - 46_600).abs() <= 100);
    assert!((calibration.position.upper_limit.0 - 137_400).abs() <= 100);
    assert!(calibration.validate().is_ok());
    let too_far = |_, inputs: &mut Inputs| {
        inputs.rocker_angle = inputs.rocker_angle.map(|angle| angle + MilliDegree(3_500))
    };
    let refused = taught_with(&hitch_model_file::dynamic(), 150.0, 120_000, too_far);
    assert_eq!(refused, Some(Err(TeachError::Ends)));
}

#[test]
fn what_is_implausible_is_refused() {
    assert_eq!(
        taught(&shifted(0.4, 0.0), 150.0),
        Err(TeachError::OutOfRange)
    );
    assert_eq!(
        taught(&shifted(0.0, -0.4), 150.0),
        Err(TeachError::OutOfRange)
    );
    assert_eq!(taught(&shifted(1.0, 0.0), 150.0), Err(TeachError::NoMotion));
    // A link that shortens the travel that the sensor sees.
    let squeezed = |_, inputs: &mut Inputs| {
        inputs.rocker_angle = inputs
            .rocker_angle
            .map(|angle| MilliDegree(90_000 + (angle.0 - 90_000) * 97 / 100));
    };
    assert_eq!(
        taught_with(&hitch_model_file::dynamic(), 150.0, 120_000, squeezed),
        Some(Err(TeachError::Ends))
    );
    // The hitch is pushed up for a moment during the third ramp.
    let pushed = |step: usize, inputs: &mut Inputs| {
        if (5_900..6_100).contains(&step) {
            inputs.rocker_angle = inputs.rocker_angle.map(|angle| angle + MilliDegree(400));
        }
    };
    assert_eq!(
        taught_with(&hitch_model_file::dynamic(), 150.0, 120_000, pushed),
        Some(Err(TeachError::Spread))
    );
}

#[test]
fn letting_go_or_a_fault_ends_it_without_a_result() {
    assert_eq!(
        taught_with(&hitch_model_file::dynamic(), 150.0, 5_000, |_, _| {}),
        Some(Err(TeachError::Aborted))
    );
    let lost = |step: usize, inputs: &mut Inputs| {
        if step > 4_000 {
            inputs.rocker_angle = None;
        }
    };
    assert_eq!(
        taught_with(&hitch_model_file::dynamic(), 150.0, 120_000, lost),
        Some(Err(TeachError::Aborted))
    );
}

#[test]
fn without_the_switch_the_button_jogs_and_without_the_button_the_switch_does_nothing() {
    let model = hitch_model_file::dynamic();
    let mut closed_loop = ClosedLoop::new(&model, &nominal(), 150.0, 40.0, 80.0, 3);
    for _ in 0..500 {
        let sample = closed_loop.step_with(60.0, |inputs| inputs.switches.teach = true, |_, _| {});
        assert_eq!(sample.outputs.state, State::Locked);
    }
    assert_eq!(closed_loop.controller().taught(), None);
}
