//! A constant that is declared too large or too small is identified like a missing effect, with its size: the campaigns
//! are of the machine in the paper, and the model declares a different value.

use std::path::Path;

use hitch_campaign::Campaign;
use hitch_identification::data::experiment::Experiment;
use hitch_identification::data::problem::Problem;
use hitch_identification::explanation::explain::{Explanation, Verdict, explain};
use hitch_plant::{Constants, Model};
use host_tests::short_moves::few_runs;

/// The clean campaign of the dynamic machine explained from a model with other constants; by day its short moves.
fn explained(declare: fn(&mut Constants)) -> Explanation {
    let campaigns = Path::new(env!("CARGO_MANIFEST_DIR")).join("campaigns");
    let campaign = few_runs(Campaign::load(&campaigns.join("clean-dynamic")).expect("shipped"));
    let mut constants = hitch_model_file::dynamic().constants().clone();
    declare(&mut constants);
    let model = Model::new("misdeclared", constants).expect("the linkage is the paper's");
    explain(
        Problem::new(&Experiment::new(&campaign, &model), &model),
        &|_| {},
    )
}

/// Asserts that one effect is named, with a size to within a share of it.
fn assert_named(found: &Explanation, effect: &str, size: f64, within: f64) {
    let named: Vec<(&str, &[f64])> = found
        .steps
        .iter()
        .map(|step| (step.effect.id(), step.values.as_slice()))
        .collect();
    assert_eq!(named.len(), 1, "{named:?}");
    assert_eq!(named[0].0, effect, "{named:?}");
    let value = named[0].1[0];
    assert!((value / size - 1.0).abs() < within, "{value} for {size}");
    let adequate = [Verdict::Explained, Verdict::Ambiguous];
    assert!(adequate.contains(&found.verdict), "{:?}", found.verdict);
}

// REQ-DIAG-06
#[test]
fn oil_softer_than_declared() {
    let found = explained(|constants| {
        constants.oil.bulk_modulus_pa /= 0.7;
    });
    assert_named(&found, "bulk-modulus", -0.3, 0.05);
}

// REQ-DIAG-06
#[test]
fn oil_stiffer_than_declared() {
    let found = explained(|constants| {
        constants.oil.bulk_modulus_pa /= 1.3;
    });
    assert_named(&found, "bulk-modulus", 0.3, 0.05);
}

#[test]
fn less_viscous_friction_than_declared() {
    let found = explained(|constants| {
        constants.cylinder.viscous_friction_n_s_m += 6000.0;
    });
    assert_named(&found, "viscous-friction", -6000.0, 0.1);
}

// REQ-DIAG-06
#[test]
fn margin_of_the_compensator_smaller_than_declared() {
    let found = explained(|constants| {
        constants.compensator.margin_pa += 0.4e5;
    });
    assert_named(&found, "compensator-margin", -0.4, 0.05);
}

#[test]
fn margin_of_the_compensator_larger_than_declared() {
    let found = explained(|constants| {
        constants.compensator.margin_pa -= 0.4e5;
    });
    assert_named(&found, "compensator-margin", 0.4, 0.05);
}

// REQ-DIAG-06
#[test]
fn spools_quicker_than_declared() {
    let found = explained(|constants| {
        constants.spool_time_constant_s += 0.02;
    });
    assert_named(&found, "spool-lag", -0.02, 0.1);
}
