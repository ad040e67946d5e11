//! `hitch adopt` and `hitch explain --baseline`: from a data sheet to what has changed.

use std::fs;
use std::path::{Path, PathBuf};

use host_tests::program::run;
use serde_json::Value;
use tempfile::TempDir;

/// A shipped campaign.
fn shipped(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("campaigns");
    folder.join(name)
}

/// The document of a command that has to succeed, and what it says beside.
fn json(dir: &TempDir, arguments: &[&str]) -> (Value, String) {
    let output = run(dir.path(), arguments);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{arguments:?}: {said}");
    let document = serde_json::from_slice(&output.stdout).expect("one JSON document");
    (document, said)
}

/// The shift of the lowering valve's threshold as a term of one's own.
const OWN_SHIFT: &str = r#"
[[term]]
id = "own-shift"
place = "lower-current"
formula = "-c"

[[term.parameter]]
name = "c"
unit = "A"
null = 0
start = 0.05
low = -0.5
high = 0.5
"#;

#[test]
fn a_data_sheet_becomes_a_machine_and_a_baseline_shows_what_has_changed() {
    let dir = TempDir::new().unwrap();
    let sheet = ["model", "new", "--out", "sheet.toml"];
    let off = [
        "--set",
        "masses.dead_weight_kg=33",
        "--set",
        "cylinder.bore_mm=76",
    ];
    assert!(
        run(dir.path(), &[&sheet[..], &off].concat())
            .status
            .success()
    );
    let clean = shipped("clean-steady");
    let clean = clean.to_str().unwrap();
    let adopt = [
        "adopt",
        clean,
        "--model",
        "sheet.toml",
        "--out",
        "machine.toml",
        "--json",
        "-",
    ];
    let hold = ["--hold", "cylinder.bore_mm"];
    let (adopted, _) = json(&dir, &[&adopt[..], &hold].concat());
    assert_eq!(adopted["verdict"], "explained");
    let constants = adopted["corrected_constants"]["constants"]
        .as_array()
        .unwrap();
    assert!(
        constants
            .iter()
            .all(|one| one["name"] != "cylinder.bore_mm"),
        "held"
    );
    let weight = constants
        .iter()
        .find(|one| one["name"] == "masses.dead_weight_kg");
    let fitted_kg = weight.unwrap()["fitted"].as_f64().unwrap();
    assert!((29.0..31.0).contains(&fitted_kg), "{fitted_kg} of 30 kg");

    let worn = shipped("known-threshold");
    let worn = worn.to_str().unwrap();
    let explain = [
        "explain",
        worn,
        "--model",
        "machine.toml",
        "--baseline",
        clean,
        "--json",
        "-",
    ];
    let (found, _) = json(&dir, &explain);
    let steps = found["steps"].as_array().unwrap();
    let named: Vec<&Value> = steps.iter().map(|step| &step["effect"]).collect();
    assert_eq!(named, ["lower-threshold-shift"]);

    // The same question in three other ways has the same answer.
    let of = |parameters: &Value, what: &str| parameters[0][what].as_f64().unwrap();
    let explained = &steps[0]["parameters"];
    let same = |value: f64, how: &str| {
        let width = of(explained, "high") - of(explained, "low");
        let off = (value - of(explained, "value")) / width;
        println!("{how}: {value} A, {off:.3} of the interval's width off");
        assert!(off.abs() < 0.02, "{how}");
    };
    let beside = ["--model", "machine.toml", "--baseline", clean];
    let (ranked, _) = json(
        &dir,
        &[&["diagnose", worn, "--json", "-"], &beside[..]].concat(),
    );
    let first = &ranked["candidates"][0];
    assert_eq!(first["effect"], "lower-threshold-shift");
    same(of(&first["parameters"], "value"), "ranked");
    let size_of = |effect: &str, model: &str| {
        let add = ["add", effect, "--campaign", worn, "--model", model];
        let add = [&add[..], &["--baseline", clean, "--out", "added.toml"]].concat();
        assert!(run(dir.path(), &add).status.success());
        let added = dir.path().join("added.toml");
        let added = hitch_model_file::named(added.to_str().unwrap()).unwrap();
        let found = added.effects.iter().find(|one| one.effect.id() == effect);
        found.unwrap().values[0]
    };
    same(size_of("lower-threshold-shift", "machine.toml"), "added");
    let machine = fs::read_to_string(dir.path().join("machine.toml")).unwrap();
    fs::write(dir.path().join("own.toml"), format!("{machine}{OWN_SHIFT}")).unwrap();
    same(size_of("own-shift", "own.toml"), "as a term of one's own");
}

#[test]
fn the_nearer_form_of_a_data_sheet_is_taken_and_said() {
    let dir = TempDir::new().unwrap();
    let sheet = ["model", "new", "--from", "dynamic", "--out", "sheet.toml"];
    assert!(run(dir.path(), &sheet).status.success());
    let friction = shipped("known-friction");
    let explain = [
        "explain",
        friction.to_str().unwrap(),
        "--json",
        "-",
        "--model",
    ];
    let (found, said) = json(&dir, &[&explain[..], &["sheet.toml"]].concat());
    assert!(
        said.contains("note: the model is taken without dynamics"),
        "{said}"
    );
    assert_eq!(found["steps"][0]["effect"], "coulomb-friction");
    let (_, said) = json(
        &dir,
        &[&explain[..], &["dynamic", "--budget", "1"]].concat(),
    );
    assert!(said.contains("warning: wrong form of the model"), "{said}");
}

#[test]
fn a_constant_to_hold_that_does_not_exist_is_refused() {
    let dir = TempDir::new().unwrap();
    let clean = shipped("clean-steady");
    let adopt = [
        "adopt",
        clean.to_str().unwrap(),
        "--out",
        "m.toml",
        "--hold",
        "cylinder.boer",
    ];
    let output = run(dir.path(), &adopt);
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(
        said.contains("cylinder.boer") && said.contains("cylinder.bore_mm"),
        "{said}"
    );
    assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 0);
}
