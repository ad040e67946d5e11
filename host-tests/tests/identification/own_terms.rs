//! A user-defined term, from the model file to the explanation, through the program.
use std::fs;
use std::path::{Path, PathBuf};

use host_tests::program::run;
use serde_json::Value;
use tempfile::TempDir;

/// A term that throttles the lowering flow near the bottom.
const END_CUSHION: &str = r#"format = 1
base = "nominal"

[[term]]
id = "end-cushion"
place = "lower-flow-factor"
formula = "-c * ramp(1 - x / depth)"

[[term.parameter]]
name = "c"
null = 0
start = 0.5
low = 0
high = 1

[[term.parameter]]
name = "depth"
unit = "mm"
start = 40
low = 5
high = 150
"#;

/// A campaign of a rig with an end cushion, which is not in the catalogue.
fn campaign() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("campaigns/known-outside")
}

/// A folder with the model file.
fn folder() -> TempDir {
    let folder = TempDir::new().expect("a folder");
    fs::write(folder.path().join("cushion.toml"), END_CUSHION).expect("a file");
    folder
}

fn printed(folder: &TempDir, arguments: &[&str]) -> String {
    let output = run(folder.path(), arguments);
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {said}");
    String::from_utf8(output.stdout).expect("text")
}

#[test]
fn a_term_in_the_model_file_is_named_and_explains_the_campaign() {
    let folder = folder();
    let campaign = campaign();
    let arguments = [
        "explain",
        campaign.to_str().expect("a path"),
        "--model",
        "cushion.toml",
        "--out",
        "found.toml",
        "--json",
        "-",
    ];
    let found: Value = serde_json::from_str(&printed(&folder, &arguments)).expect("JSON");
    let steps = found["steps"].as_array().expect("steps");
    let step = steps.iter().find(|step| step["effect"] == "end-cushion");
    let step = step.unwrap_or_else(|| panic!("not named: {steps:?}"));
    let depth_mm = &step["parameters"][1]["value"];
    assert!((50.0..80.0).contains(&depth_mm.as_f64().expect("a depth")));
    let last = &steps[steps.len() - 1]["held_out_after"];
    assert!(last.as_f64().expect("an error") <= 1.15, "held out {last}");
    let file = fs::read_to_string(folder.path().join("found.toml")).expect("the model");
    assert!(file.contains("[[term]]") && file.contains("[[effect]]\nid = \"end-cushion\""));
}

#[test]
fn a_term_is_suggested_where_the_catalogue_ends() {
    let folder = TempDir::new().expect("a folder");
    let campaign = campaign();
    let arguments = [
        "explain",
        campaign.to_str().expect("a path"),
        // The answer is tested, not its time on a machine that does other work as well.
        "--budget",
        "600",
        "--out",
        "found.toml",
        "--report",
        "found.html",
        "--json",
        "-",
    ];
    let found: Value = serde_json::from_str(&printed(&folder, &arguments)).expect("JSON");
    assert_eq!(found["verdict"], "unexplained");
    let unexplained = &found["unexplained"];
    assert_eq!(unexplained["depends_on"][0], "rocker_angle_deg");
    let place = unexplained["where"].as_str().expect("where it is largest");
    assert!(place.ends_with("near the bottom while lowering"), "{place}");
    let suggested = &unexplained["suggested"];
    assert_eq!(suggested["place"], "lower-flow-factor", "{suggested}");
    let formula = suggested["formula"].as_str().expect("a formula");
    assert!(formula.contains("x"), "{formula}");
    let term = unexplained["suggested_term"].as_str().expect("a term");
    assert!(term.contains(formula), "{term}");
    let held_out = suggested["held_out_after"].as_f64().expect("an error");
    assert!(held_out <= 1.15, "held out {held_out}");
    let report = fs::read_to_string(folder.path().join("found.html")).expect("the report");
    assert!(report.contains("near the bottom while lowering") && report.contains("[[term]]"));
    let file = fs::read_to_string(folder.path().join("found.toml")).expect("the model");
    assert!(file.contains("[[term]]"));

    let pasted = suggested["model_file"].as_str().expect("a text");
    let pasted = format!("format = 1\nbase = \"nominal\"\n\n{pasted}");
    fs::write(folder.path().join("pasted.toml"), pasted).expect("a file");
    let id = found_id(&folder);
    let arguments = [
        "add",
        &id,
        "--campaign",
        campaign.to_str().expect("a path"),
        "--model",
        "pasted.toml",
        "--out",
        "added.toml",
    ];
    let added = printed(&folder, &arguments);
    let error = added.rsplit("error ").next().expect("an error");
    let error: f64 = error
        .split(' ')
        .next()
        .expect("a number")
        .parse()
        .expect("a number");
    assert!(error <= 1.15, "{added}");
}

/// The name of the term in the pasted file.
fn found_id(folder: &TempDir) -> String {
    let file = fs::read_to_string(folder.path().join("pasted.toml")).expect("the model");
    let (_, rest) = file.split_once("[[term]]\nid = \"").expect("a term");
    rest.split('"').next().expect("a name").to_owned()
}

#[test]
fn a_term_can_be_listed_and_added() {
    let folder = folder();
    let listed = printed(
        &folder,
        &["effects", "--model", "cushion.toml", "end-cushion"],
    );
    assert!(listed.contains("lower-flow-factor = -c * ramp(1 - x / depth)"));
    let campaign = campaign();
    let campaign = campaign.to_str().expect("a path");
    let arguments = [
        "add",
        "end-cushion",
        "--campaign",
        campaign,
        "--model",
        "cushion.toml",
        "--out",
        "with.toml",
    ];
    let added = printed(&folder, &arguments);
    assert!(added.contains("+ end-cushion: c "), "{added}");
    let formulas = printed(&folder, &["effects", "--formulas"]);
    assert!(formulas.contains("rocker_angle") && formulas.contains("lower-flow-factor"));
}
