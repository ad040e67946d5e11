//! Changes of a machine with a known model: adopted effects stay unless the measurements show a change, which is a step
//! like a new effect.

use std::path::{Path, PathBuf};
use std::sync::Mutex;

use hitch_campaign::Campaign;
use hitch_effects::find;
use hitch_identification::data::experiment::Experiment;
use hitch_identification::data::problem::Problem;
use hitch_identification::estimation::fit::Fit;
use hitch_identification::explanation::explain::{Explanation, Verdict, explain_with};
use hitch_identification::search::options::Options;
use hitch_plant::AddedEffect;
use host_tests::program::run;
use serde_json::Value;

/// Coulomb friction hidden in `known-friction`, N.
const HIDDEN_N: f64 = 725.0;

fn campaigns() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("campaigns")
}

/// `known-friction` explained from the paper's machine with this adopted friction.
fn from_adopted(friction_n: f64, changes: bool) -> Explanation {
    let effect = find("coulomb-friction").expect("in the catalogue");
    let mut adopted = AddedEffect::typical(effect);
    adopted.values[0] = friction_n;
    let model = hitch_model_file::nominal().with_effects(vec![adopted]);
    let campaign = Campaign::load(&campaigns().join("known-friction")).expect("shipped");
    let options = Options {
        changes,
        ..Options::default()
    };
    explain_with(
        Problem::new(&Experiment::new(&campaign, &model), &model),
        options,
        &|_| {},
    )
}

// REQ-DIAG-07
#[test]
fn a_change_of_an_adopted_effect_is_a_step() {
    let found = from_adopted(300.0, true);
    assert_eq!(found.steps.len(), 1);
    let step = &found.steps[0];
    assert_eq!(step.effect.id(), "coulomb-friction");
    assert_eq!(step.changed_from, Some(300.0));
    assert!(
        (step.values[0] / HIDDEN_N - 1.0).abs() < 0.01,
        "{:?}",
        step.values
    );
    let (low, high) = step.intervals[0];
    assert!((low..=high).contains(&HIDDEN_N), "{low} to {high}");
    assert_eq!(found.verdict, Verdict::Explained);
    let refitted = found.refitted.as_ref().expect("the model has an effect");
    assert!(found.before.error() > 2.0 && refitted.error() < 1.1);
}

// REQ-DIAG-07
#[test]
fn what_is_as_it_was_adopted_has_not_changed() {
    let found = from_adopted(HIDDEN_N, true);
    assert!(found.steps.is_empty());
    assert_eq!(found.verdict, Verdict::NothingMissing);
}

#[test]
fn a_frozen_model_keeps_its_effects() {
    let found = from_adopted(300.0, false);
    let named: Vec<&str> = found.steps.iter().map(|step| step.effect.id()).collect();
    assert!(!named.contains(&"coulomb-friction"), "{named:?}");
    assert_eq!(found.after.estimate.effects[0].values[0], 300.0);
}

#[test]
fn each_partial_result_is_better_and_the_last_one_is_the_answer() {
    let model = hitch_model_file::nominal();
    let campaign = Campaign::load(&campaigns().join("known-leak-and-lag")).expect("shipped");
    let experiment = Experiment::new(&campaign, &model);
    let accounts = Mutex::new(Vec::new());
    let options = Options {
        improved: &|fit: &Fit| accounts.lock().unwrap().push(fit.clone()),
        ..Options::default()
    };
    let found = explain_with(Problem::new(&experiment, &model), options, &|_| {});
    let accounts = accounts.into_inner().unwrap();
    let costs: Vec<f64> = accounts.iter().map(|fit| fit.cost).collect();
    assert!(
        !costs.is_empty() && costs.is_sorted_by(|a, b| a > b),
        "{costs:?}"
    );
    let ids = |fit: &Fit| {
        let effects = fit.estimate.effects.iter();
        let mut ids: Vec<&str> = effects.map(|added| added.effect.id()).collect();
        ids.sort_unstable();
        ids
    };
    assert_eq!(ids(&accounts[accounts.len() - 1]), ids(&found.after));
}

/// Output of the command for two campaigns, as JSON.
fn changes(baseline: &str, new: &str) -> Value {
    let output = run(&campaigns(), &["changes", baseline, new, "--json", "-"]);
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    serde_json::from_slice(&output.stdout).expect("one JSON document")
}

#[test]
fn the_command_says_what_differs_between_two_campaigns() {
    let worse = changes("clean-steady", "known-friction");
    assert_eq!(worse["baseline"]["verdict"], "nothing-missing");
    assert_eq!(worse["new"]["steps"][0]["effect"], "coulomb-friction");
    let same = changes("known-friction", "known-friction");
    assert_eq!(same["baseline"]["steps"][0]["effect"], "coulomb-friction");
    assert_eq!(same["new"]["steps"].as_array().map(Vec::len), Some(0));
}

#[test]
fn a_search_ends_with_its_budget_and_says_so() {
    let arguments = ["explain", "known-friction", "--budget", "0", "--json", "-"];
    let output = run(&campaigns(), &arguments);
    assert!(output.status.success());
    let found: Value = serde_json::from_slice(&output.stdout).expect("one JSON document");
    assert_eq!(found["unfinished"], true);
}
