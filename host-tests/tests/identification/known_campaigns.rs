//! Campaigns of an independent rig with known hidden physics: exactly the hidden effects are named.
//!
//! `campaigns/NAME.truth.json` lists the hidden effects of `campaigns/NAME`.

use std::path::{Path, PathBuf};

use hitch_campaign::Campaign;
use hitch_identification::adequacy::signal::Signal;
use hitch_identification::data::experiment::Experiment;
use hitch_identification::data::problem::Problem;
use hitch_identification::explanation::explain::{Explanation, Verdict, explain};
use hitch_plant::{Dynamics, Model};
use host_tests::short_moves::few_runs;

fn campaigns() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("campaigns")
}

/// A dynamic model explains the short moves by day.
fn explained(name: &str, model: &Model) -> Explanation {
    let campaign = Campaign::load(&campaigns().join(name)).expect("a shipped campaign");
    let rings = model.constants().dynamics == Dynamics::Dynamic;
    let campaign = if rings { few_runs(campaign) } else { campaign };
    explain(
        Problem::new(&Experiment::new(&campaign, model), model),
        &|_| {},
    )
}

/// The hidden effects, by id.
fn hidden(name: &str) -> Vec<(String, f64)> {
    let text = std::fs::read_to_string(campaigns().join(format!("{name}.truth.json")));
    let truth: serde_json::Value =
        serde_json::from_str(&text.expect("a truth beside the campaign")).expect("JSON");
    let hidden = truth["hidden"].as_object().expect("the hidden effects");
    hidden
        .iter()
        .map(|(id, value)| (id.clone(), value.as_f64().expect("a number")))
        .collect()
}

fn is_named(name: &str) {
    is_named_on(name, &hitch_model_file::nominal());
}

fn is_named_on(name: &str, model: &Model) {
    let explanation = explained(name, model);
    let hidden = hidden(name);
    let named: Vec<&str> = explanation
        .steps
        .iter()
        .map(|step| step.effect.id())
        .collect();
    assert_eq!(named.len(), hidden.len(), "{name}: {named:?} named");
    for (id, value) in &hidden {
        let step = explanation.steps.iter().find(|step| step.effect.id() == id);
        let found = step
            .unwrap_or_else(|| panic!("{name}: {id} not among {named:?}"))
            .values[0];
        assert!(
            (found / value - 1.0).abs() < 0.10,
            "{name}: {id} {found}, not {value}"
        );
    }
    assert_eq!(explanation.verdict, Verdict::Explained, "{name}");
    let last = explanation.steps.last().expect("a step");
    assert!(
        last.held_out_after.error <= 1.10,
        "{name}: held out {}",
        last.held_out_after.error
    );
    assert!(
        last.held_out_before.error > 2.0 * last.held_out_after.error,
        "{name}"
    );
}

fn nothing_is_named(name: &str, model: &Model) {
    let explanation = explained(name, model);
    assert!(
        explanation.steps.is_empty(),
        "{name}: {:?}",
        explanation.steps[0].effect.id()
    );
    assert_eq!(explanation.verdict, Verdict::NothingMissing, "{name}");
    let error = explanation.before.error();
    assert!((0.95..=1.10).contains(&error), "{name}: error {error}");
}

#[test]
fn a_shifted_threshold_is_named() {
    is_named("known-threshold");
}

// REQ-DIAG-01
#[test]
fn friction_is_named() {
    is_named("known-friction");
}

// REQ-DIAG-01
#[test]
fn hysteresis_is_named() {
    is_named("known-hysteresis");
}

#[test]
fn back_pressure_is_named() {
    is_named("known-return-line");
}

// REQ-DIAG-04
#[test]
fn a_leak_and_a_sensor_lag_are_both_named() {
    is_named("known-leak-and-lag");
}

#[test]
fn a_drooping_compensator_is_named() {
    is_named("known-droop-rough");
}

/// Duty cycles alone, without a flow bench.
#[test]
fn a_flow_force_is_named_from_field_logs() {
    is_named("known-field");
}

#[test]
fn air_in_the_oil_is_named_where_pressures_ring() {
    is_named_on("known-air", &hitch_model_file::dynamic());
}

// REQ-DIAG-02
#[test]
fn nothing_is_named_where_nothing_is_hidden() {
    nothing_is_named("clean-steady", &hitch_model_file::nominal());
    nothing_is_named("clean-rough", &hitch_model_file::nominal());
}

// REQ-DIAG-02
#[test]
fn nothing_is_named_where_nothing_is_hidden_and_pressures_ring() {
    nothing_is_named("clean-dynamic", &hitch_model_file::dynamic());
}

/// The quasi-static model is not adequate for a dynamic rig, and no effect of the catalogue replaces inertia.
#[test]
fn the_wrong_starting_point_is_not_called_adequate() {
    let explanation = explained("clean-dynamic", &hitch_model_file::nominal());
    assert_eq!(explanation.verdict, Verdict::Unexplained);
}

// REQ-DIAG-03
/// An end cushion is not in the catalogue: the remaining error has to be reported, with its correlation with the angle.
#[test]
fn what_is_not_in_the_catalogue_is_unexplained() {
    let explanation = explained("known-outside", &hitch_model_file::nominal());
    assert_eq!(explanation.verdict, Verdict::Unexplained);
    assert!(explanation.rest.share > 0.2);
    assert_eq!(explanation.rest.depends_on[0], Signal::RockerAngle);
}
