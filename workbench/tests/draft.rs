//! `hitch draft` on an example campaign: text, document, report, faults, and the way to a calibration.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

fn hitch(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_hitch"))
        .current_dir(folder)
        .args(arguments)
        .output()
        .expect("it starts")
}

fn said(output: &Output) -> String {
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    String::from_utf8_lossy(&output.stdout).into_owned()
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).expect("it was written")
}

/// The example is a plough with 1.15 times the standard's draft in loam, and with blunt shares of 3500 N/m.
#[test]
fn an_example_is_explained_and_calibrated_from() {
    let dir = tempfile::tempdir().expect("a folder");
    let folder = dir.path();
    said(&hitch(folder, &["draft", "field", "--example", "1"]));
    let arguments = [
        "draft",
        "field",
        "--json",
        "draft.json",
        "--report",
        "draft.html",
    ];
    let text = said(&hitch(folder, &arguments));
    assert!(
        text.contains("blunt shares") && text.contains("The run that says most"),
        "{text}"
    );
    let document: Value = serde_json::from_str(&read(&folder.join("draft.json"))).expect("JSON");
    let number = |value: &Value| value.as_f64().expect("a number");
    let ratio = &document["over_standard"];
    assert!(
        number(&ratio["low"]) < 1.15 && 1.15 < number(&ratio["high"]),
        "{ratio}"
    );
    let effects = document["effects"].as_array().expect("effects");
    let present: Vec<&Value> = effects
        .iter()
        .filter(|effect| effect["verdict"] == "present")
        .collect();
    assert_eq!(present.len(), 1, "{effects:?}");
    assert_eq!(present[0]["effect"], "blunt-shares");
    let [low, high] = ["low", "high"].map(|end| number(&present[0][end]));
    assert!(low < 3500.0 && 3500.0 < high, "{low} to {high}");
    let report = read(&folder.join("draft.html"));
    assert!(report.contains("Draft at 16 cm") && report.contains("Draft at 26 cm"));
    let arguments = [
        "calibrate",
        "nominal",
        "--draft",
        "draft.json",
        "--out",
        "c.toml",
    ];
    let text = said(&hitch(folder, &arguments));
    assert!(text.contains("draft.force_per_degree"), "{text}");
    let per_cm = number(&document["draft_per_cm"]["value"]);
    let calibration = read(&folder.join("c.toml"));
    let value = |name: &str| -> f64 {
        let line = calibration.lines().find(|line| line.starts_with(name));
        let line = line.unwrap_or_else(|| panic!("{name} is in {calibration}"));
        let number = line.split(['=', '#']).nth(1).expect("a value").trim();
        number.replace('_', "").parse().expect("a number")
    };
    let cm_per_degree = value("force_per_degree") / per_cm;
    assert!((0.5..1.5).contains(&cm_per_degree), "{cm_per_degree}");
}

#[test]
fn a_fault_is_one_line_with_its_place_and_code_2() {
    let dir = tempfile::tempdir().expect("a folder");
    let folder = dir.path();
    said(&hitch(folder, &["draft", "field", "--example", "2"]));
    let refused = |expected: &str, arguments: &[&str]| {
        let output = hitch(folder, arguments);
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{text}");
        assert_eq!(text.lines().count(), 1, "{text}");
        assert!(text.contains(expected), "{text}");
    };
    let manifest = folder.join("field").join("campaign.toml");
    let whole = read(&manifest);
    fs::write(&manifest, whole.replace("medium", "loam")).expect("written");
    refused("campaign.toml:9:11: texture \"loam\"", &["draft", "field"]);
    fs::write(&manifest, &whole).expect("written");
    refused("no such folder", &["draft", "meadow"]);
    refused(
        "would be overwritten",
        &["draft", "field", "--json", "field/run-1.csv"],
    );
    refused("exists already", &["draft", "field", "--example", "2"]);
    fs::write(folder.join("bad.json"), "{\"a\": 1}").expect("written");
    let arguments = [
        "calibrate",
        "nominal",
        "--draft",
        "bad.json",
        "--out",
        "c.toml",
    ];
    refused("bad.json:1:8: is no result of a draft campaign", &arguments);
}
