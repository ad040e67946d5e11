//! The complete process: valves with several deviations are measured, explained, calibrated and driven.

use hitch_closed_loop::calibrate::calibrate;
use hitch_effects::find;
use hitch_identification::data::experiment::Experiment;
use hitch_identification::data::problem::Problem;
use hitch_identification::explanation::explain::{Verdict, explain};
use hitch_plant::AddedEffect;
use hitch_quantities::{Calibration, ValidCalibration};
use hitch_results::closed_loop::{LoopRun, Scenario, run};
use rand::SeedableRng;
use rand_pcg::Pcg64;
use truth_rigs::simulated_lab::campaign;

const SEED: u64 = 20;

/// Deviations of the valves: threshold, saturation, flow force, hysteresis.
const HIDDEN: [(&str, f64); 4] = [
    ("lower-threshold-shift", 0.2),
    ("lower-flow-scale", -0.067),
    ("flow-force", 0.3),
    ("solenoid-hysteresis", 0.08),
];

fn hidden() -> Vec<AddedEffect> {
    let effect = |(id, size): &(&str, f64)| {
        let mut added = AddedEffect::typical(find(id).unwrap());
        added.values[0] = *size;
        added
    };
    HIDDEN.iter().map(effect).collect()
}

/// Mean time ratio and tracking error, degree, of the lowering moves of a scenario.
fn lowering(run: &LoopRun) -> (f64, f64) {
    let moves = run.results.iter().filter(|r| r.to_deg < r.from_deg);
    let (mut ratio, mut tracking_deg, mut count) = (0.0, 0.0, 0.0);
    for result in moves {
        ratio += result.ratio;
        tracking_deg += result.tracking_error_deg;
        count += 1.0;
    }
    (ratio / count, tracking_deg / count)
}

// REQ-MOTION-06
#[test]
fn several_deviations_of_the_valves_are_found_and_the_motion_is_better_by_them() {
    let nominal_model = hitch_model_file::nominal();
    let rig = nominal_model.with_effects(hidden());
    let campaign = campaign(&rig, &mut Pcg64::seed_from_u64(SEED));
    let experiment = Experiment::new(&campaign, &nominal_model);
    let found = explain(Problem::new(&experiment, &nominal_model), &|_| {});
    for step in &found.steps {
        println!(
            "{} {:?} {:?}",
            step.effect.id(),
            step.values,
            step.intervals
        );
    }
    let mut named: Vec<&str> = found.steps.iter().map(|step| step.effect.id()).collect();
    named.sort_unstable();
    let mut wanted = HIDDEN.map(|(id, _)| id);
    wanted.sort_unstable();
    assert_eq!(named, wanted, "seed {SEED}");
    assert_ne!(found.verdict, Verdict::Unexplained, "seed {SEED}");
    assert!(found.after.error() <= 1.1, "{}", found.after.error());

    let identified = nominal_model.with_effects(found.after.estimate.effects.clone());
    let driven_rig = hitch_model_file::dynamic().with_effects(hidden());
    let driven = |calibration: &ValidCalibration, scenario: Scenario| {
        let run = run(&driven_rig, calibration, &scenario.moves(&driven_rig, None)).unwrap();
        println!("{:?}", run.summary);
        run
    };
    let nominal = Calibration::nominal().validate().unwrap();
    let rebuilt = calibrate(&identified, &Calibration::nominal()).unwrap();
    let (ratio_before, tracking_before_deg) = lowering(&driven(&nominal, Scenario::Fine));
    let (ratio_after, tracking_after_deg) = lowering(&driven(&rebuilt, Scenario::Fine));
    println!(
        "lowering by 1 to 3 degrees: time over shortest {ratio_before:.2} -> {ratio_after:.2}, \
         tracking error {tracking_before_deg:.3} -> {tracking_after_deg:.3} deg"
    );
    assert!(ratio_after <= ratio_before - 0.2);
    assert!(tracking_after_deg <= 0.9 * tracking_before_deg);
    for result in &driven(&rebuilt, Scenario::Moves).results {
        assert!(
            result.overshoot_deg <= 0.3 && result.final_error_deg <= 0.3,
            "{result:?}"
        );
        assert_eq!(result.switched_on_after, 0, "{result:?}");
    }
}
