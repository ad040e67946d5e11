//! Declared models whose constants are off as those of a data sheet: the constants are corrected, and do not become
//! effects.

use hitch_identification::data::experiment::Experiment;
use hitch_identification::data::problem::Problem;
use hitch_identification::explanation::diagnosis::diagnose;
use hitch_identification::explanation::explain::{Explanation, Verdict, explain, fit_base};
use hitch_model_file::Valve;
use hitch_plant::full_name;
use hitch_plant::units::lpm_from_m3_s;
use host_tests::hidden_effects::starting_point;
use host_tests::hidden_effects::wrong_base::declared;
use host_tests::second_rig::campaign_writer::campaign;
use host_tests::second_rig::draw::{Case, Kind, Wish, draw};
use host_tests::second_rig::hideable::{Fidelity, find};
use host_tests::second_rig::manoeuvres::Plan;
use host_tests::second_rig::test_stand::Family;

/// Largest error of an adequate model, sigma.
const NOISE: f64 = 1.1;

/// Smallest probability that counts as an assertion.
const ASSERTED: f64 = 0.95;

fn case(seed: u64, hidden: Option<(&str, f64)>) -> Case {
    let wish = Wish {
        family: Family::Steady,
        plan: Plan::Lab,
        fidelity: Some(Fidelity::Faithful),
        rough: Some(false),
        kind: Some(Kind::Nothing),
        effect: hidden.map(|(id, size)| (find(id).expect("a hideable effect"), Some(size))),
        known: |_| true,
    };
    draw(seed, &wish)
}

/// An explanation that starts from a wrong declared model.
fn explained(case: &Case) -> Explanation {
    let declared = declared(case.family, case.seed);
    let experiment = Experiment::new(&campaign(case), &declared);
    let found = explain(Problem::new(&experiment, &declared), &|_| {});
    println!(
        "seed {}: error {:.2} declared, {:.3} after, {}",
        case.seed,
        found.before.error(),
        found.after.error(),
        found.verdict.name()
    );
    for step in &found.steps {
        println!("  {} at {:.2}", full_name(step.effect), step.confidence);
    }
    found
}

// REQ-DIAG-13
#[test]
fn constants_that_are_off_do_not_become_effects() {
    let found = explained(&case(801, None));
    assert!(found.before.error() > 2.0 && found.after.error() < NOISE);
    assert!(found.steps.iter().all(|step| step.confidence < ASSERTED));
    assert_eq!(found.verdict, Verdict::Explained);
    let corrected = found.corrected.expect("corrected constants");
    let truth = starting_point(Family::Steady);
    let true_flows = [Valve::Lift, Valve::Lower].into_iter().flat_map(|valve| {
        let flows = valve.of(truth.constants()).curve.flows_m3_s();
        flows.iter().filter(|flow| **flow > 0.0)
    });
    let (mut declared_worst, mut fitted_worst) = (0.0, 0.0);
    for (point, &flow) in corrected.curves.iter().zip(true_flows) {
        let off = |flow_lpm: f64| (flow_lpm / lpm_from_m3_s(flow) - 1.0).abs();
        if point.determined {
            declared_worst = f64::max(declared_worst, off(point.declared_lpm));
            fitted_worst = f64::max(fitted_worst, off(point.fitted_lpm));
        }
    }
    println!("flows off by at most {declared_worst:.3} declared, {fitted_worst:.3} fitted");
    assert!(declared_worst > 0.05 && fitted_worst < 0.02);
}

// REQ-DIAG-13
#[test]
fn a_hidden_effect_is_identified_beside_constants_that_are_off() {
    let true_size = 0.006;
    let found = explained(&case(802, Some(("lowering-leakage", true_size))));
    assert!(found.after.error() < NOISE && found.corrected.is_some());
    let asserted: Vec<&str> = found
        .steps
        .iter()
        .filter(|step| step.confidence >= ASSERTED)
        .map(|step| step.effect.id())
        .collect();
    assert_eq!(asserted, ["lowering-leakage"]);
    let (low, high) = found.steps[0].intervals[0];
    println!("{low} to {high}");
    assert!((low..=high).contains(&true_size));
}

// REQ-DIAG-13
#[test]
fn a_diagnosis_asserts_no_effect_if_the_constants_are_off() {
    let case = case(803, None);
    let declared = declared(case.family, case.seed);
    let experiment = Experiment::new(&campaign(&case), &declared);
    let problem = Problem::new(&experiment, &declared);
    let found = diagnose(problem, fit_base(problem), &|_| {});
    let best = found.confidences.iter().copied().fold(0.0, f64::max);
    println!("off with {:.2}, best effect {best:.2}", found.constants_off);
    assert!(found.constants_off > 0.9 && best < ASSERTED);
}
