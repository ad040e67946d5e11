//! In work, and the time until then: the controller with hitch, tractor and field.

use hitch_closed_loop::field::{
    FieldRig, FieldSample, LINK_DEPTH_M, RAISED_DEG, Settings, TOUCH_DEG,
};
use hitch_field::draft::Texture;
use hitch_field::soil::SoilPlan;
use hitch_field::terrain::Terrain;
use hitch_field::tractor::TractorConstants;
use hitch_quantities::units::{MilliDegree, PerMille};
use hitch_quantities::{Calibration, Function, State, ValidCalibration};
use hitch_results::field_loop::pass::{DRAFT_N, SPEED_M_S, fitted_with};
use host_tests::seeds::cases;

/// The threshold is where the share touches the ground.
fn with_threshold(change: impl FnOnce(&mut Calibration)) -> ValidCalibration {
    fitted_with(|calibration| {
        calibration.work.angle = MilliDegree((TOUCH_DEG * 1e3) as i32);
        change(calibration);
    })
}

/// Two seconds raised, then lowered to a depth of the links, m, and raised again at the end.
fn driven(
    calibration: &ValidCalibration,
    function: Function,
    (depth_m, dial): (f64, Option<i32>),
    seed: u64,
) -> Vec<FieldSample> {
    let model = hitch_model_file::dynamic();
    let field = (
        TractorConstants::ploughing(),
        SoilPlan::varying(Texture::Medium),
    );
    let mut rig = FieldRig::new(&model, calibration, field, Terrain::flat(), seed);
    let deep_deg = rig.coupling().angle_deg(depth_m);
    let settings = Settings {
        function,
        draft_n: Some(DRAFT_N),
        ..Settings::default()
    };
    let lever_deg = |step| match step {
        2_000..12_000 => deep_deg,
        _ => RAISED_DEG,
    };
    (0..15_000)
        .map(|step| {
            rig.step(lever_deg(step), SPEED_M_S, &settings, |inputs| {
                inputs.lowering_dial = dial.map(PerMille);
            })
        })
        .collect()
}

#[test]
fn the_state_changes_once_when_the_implement_enters_the_soil_and_once_when_it_leaves() {
    let calibration = with_threshold(|_| {});
    for function in [Function::Position, Function::Draft, Function::DepthLimit] {
        for seed in 1..=cases(2, 10) {
            let samples = driven(&calibration, function, (LINK_DEPTH_M, None), seed);
            let states: Vec<bool> = samples
                .iter()
                .skip(1)
                .map(|sample| sample.hitch.outputs.in_work.unwrap())
                .collect();
            let changes = states.windows(2).filter(|pair| pair[0] != pair[1]).count();
            assert_eq!(changes, 2, "{function:?}, seed {seed}");
            let begins = states.iter().position(|works| *works).unwrap();
            let ends = begins + states[begins..].iter().position(|works| !works).unwrap();
            let deep = |at: usize| samples[at + 1].field.depth_m;
            let touches = samples
                .iter()
                .position(|sample| sample.hitch.angle_deg <= TOUCH_DEG)
                .unwrap();
            println!(
                "{function:?}, seed {seed}: in work {} ms after the links were down, out of work at a depth of {:.1} cm",
                begins as i64 - touches as i64,
                deep(ends) * 100.0
            );
            assert!(begins.abs_diff(touches) <= 60);
            assert!(deep(ends) <= 0.05, "{} m", deep(ends));
        }
    }
}

/// Errors of the predicted time, s, with the time that was left, s, over a lowering.
fn errors_s(samples: &[FieldSample]) -> Vec<(f64, f64)> {
    let works = |sample: &FieldSample| sample.hitch.outputs.in_work == Some(true);
    let begins = samples.iter().position(works).unwrap();
    samples[..begins]
        .iter()
        .enumerate()
        .filter_map(|(step, sample)| {
            let predicted = sample.hitch.outputs.time_until_work?;
            let left_s = (begins - step) as f64 * 1e-3;
            Some((f64::from(predicted.0) * 1e-3 - left_s, left_s))
        })
        .collect()
}

#[test]
fn the_time_until_work_is_predicted_at_each_dial_and_depth() {
    for function in [Function::Position, Function::Draft] {
        for dial in [Some(250), Some(350), Some(600), None] {
            for depth_m in [0.03, 0.10, LINK_DEPTH_M] {
                let samples = driven(&with_threshold(|_| {}), function, (depth_m, dial), 1);
                let errors = errors_s(&samples);
                let lowering = samples[..14_000]
                    .iter()
                    .filter(|sample| {
                        sample.hitch.outputs.state == State::Lowering
                            && sample.hitch.outputs.in_work == Some(false)
                    })
                    .count();
                let &(first_s, left_s) = errors.first().unwrap();
                let worst_s = errors.iter().map(|(off, _)| off.abs()).fold(0.0, f64::max);
                let late_s = errors
                    .iter()
                    .filter(|(_, left)| *left <= 0.5 * left_s)
                    .map(|(off, _)| off.abs())
                    .fold(0.0, f64::max);
                println!(
                    "{function:?}, dial {dial:?}, {depth_m} m: {left_s:.3} s, first {first_s:+.3} s, at most {worst_s:.3} s, in the second half {late_s:.3} s; {} of {lowering} steps",
                    errors.len()
                );
                assert!(errors.len() + 5 >= lowering, "told all the way");
                assert!(worst_s <= 0.1 + 0.05 * left_s, "{worst_s} s");
                assert!(late_s <= 0.02 + 0.05 * left_s, "{late_s} s");
            }
        }
    }
}
