//! `hitch tune`, and tuning by hand with `hitch loop --set`.

use std::path::Path;

use host_tests::html_report::{assert_self_contained, plots, without_library};
use host_tests::program::run;
use host_tests::seeds::cases;

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// Summary of `hitch loop` on the quick moves.
fn summary(folder: &Path, more: &[&str]) -> serde_json::Value {
    let mut arguments = vec!["loop", "--scenario", "quick", "--json", "-"];
    arguments.extend(more);
    let output = run(folder, &arguments);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let document: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    document["summary"].clone()
}

#[test]
fn tuning_makes_a_bad_calibration_better_and_writes_one_that_can_be_driven() {
    let folder = tempfile::tempdir().unwrap();
    let bad =
        "format = 1\n[position]\nlower_deceleration_mm_per_s2 = 400\ncreep_speed_mm_per_s = 30\n";
    std::fs::write(folder.path().join("bad.toml"), bad).unwrap();
    let arguments =
        "tune --calibration bad.toml --scenario quick --trials 60 --out tuned.toml --report r.html";
    let output = run(folder.path(), &arguments.split(' ').collect::<Vec<_>>());
    let said = text(&output.stdout);
    println!("{said}");
    assert!(output.status.success(), "{}", text(&output.stderr));
    // The search lowers its cost, which weighs all figures; the slowest moves of the written calibration are driven again.
    let slowest = |calibration: &str| {
        summary(folder.path(), &["--calibration", calibration])["ratio_p95"]
            .as_f64()
            .unwrap()
    };
    let (before, after) = (slowest("bad.toml"), slowest("tuned.toml"));
    println!("time ratio, 95 %: {before:.3} -> {after:.3}");
    assert!(after <= before - 0.02, "{before} -> {after}");
    let costs: Vec<f64> = said
        .lines()
        .find(|line| line.trim_start().starts_with("cost"))
        .map(|line| {
            line.split_whitespace()
                .filter_map(|cell| cell.parse().ok())
                .collect()
        })
        .unwrap();
    assert!(costs[1] < 0.9 * costs[0], "{costs:?}");
    assert_shows_both(&std::fs::read_to_string(folder.path().join("r.html")).unwrap());
}

/// The report has each of the twelve quick moves with both calibrations, and the changed values.
fn assert_shows_both(html: &str) {
    assert_self_contained(html);
    let own = without_library(html);
    let views = plots(html);
    assert_eq!(views.len(), 12);
    for view in &views {
        let angles = view["rows"][0]["lines"].as_array().unwrap();
        let names: Vec<&str> = angles
            .iter()
            .map(|line| line["name"].as_str().unwrap())
            .collect();
        assert_eq!(names, ["set point", "before", "after"]);
        assert_ne!(angles[1]["y"], angles[2]["y"]);
    }
    assert!(own.contains("position.lower_deceleration"));
}

#[test]
fn tuning_the_button_reduces_the_overshoot_of_its_speed() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = cases(
        "tune --scenario rate --loads 50,250 --trials 20 --out tuned.toml --report r.html --json -",
        "tune --scenario rate --loads 50,250 --trials 40 --out tuned.toml --report r.html --json -",
    );
    let output = run(folder.path(), &arguments.split(' ').collect::<Vec<_>>());
    assert!(output.status.success(), "{}", text(&output.stderr));
    let document: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let changes = document["changes"].as_array().unwrap();
    let keys = changes.iter().map(|change| change["key"].as_str().unwrap());
    assert!(
        keys.clone().all(|key| key.starts_with("rate.")),
        "{document}"
    );
    assert_eq!(keys.count(), 3);
    let figure = |when: &str, name: &str| document[when]["presses"][name].as_f64().unwrap();
    let [before, after] = ["before", "after"].map(|when| figure(when, "speed_overshoot_max"));
    let [earlier, later] = ["before", "after"].map(|when| figure(when, "start_delay_max_s"));
    println!("overshoot {before:.3} -> {after:.3}, latest start {earlier:.3} -> {later:.3} s");
    assert!(after < 0.75 * before, "{before} {after}");
    assert!(figure("after", "speed_error_max") < 0.05);
    assert!(document["before"]["summary"].is_null(), "no moves");
    let html = std::fs::read_to_string(folder.path().join("r.html")).unwrap();
    assert_self_contained(&html);
    // Two loads, three speeds, both directions.
    assert_eq!(plots(&html).len(), 12);
}

#[test]
fn a_value_set_by_hand_is_driven_and_a_wrong_one_is_refused_in_one_line() {
    let folder = tempfile::tempdir().unwrap();
    let swift = summary(folder.path(), &[]);
    let slow = summary(
        folder.path(),
        &[
            "--set",
            "position.lift_speed=30",
            "--set",
            "position.lower_speed=30",
        ],
    );
    assert!(slow["ratio_p95"].as_f64().unwrap() > swift["ratio_p95"].as_f64().unwrap() + 0.5);
    for bad in ["position.kd=1", "position.approach_gain=1e6", "nonsense"] {
        let output = run(folder.path(), &["loop", "--set", bad]);
        assert_eq!(output.status.code(), Some(2), "{bad}");
        let said = text(&output.stderr);
        assert!(
            said.starts_with("hitch: --set: ") && said.lines().count() == 1,
            "{said}"
        );
    }
}

#[test]
fn a_value_set_by_hand_is_left_alone_by_the_search() {
    let folder = tempfile::tempdir().unwrap();
    let arguments =
        "tune --scenario quick --trials 10 --out tuned.toml --force --set position.creep_speed=9";
    let output = run(folder.path(), &arguments.split(' ').collect::<Vec<_>>());
    assert!(output.status.success(), "{}", text(&output.stderr));
    let tuned = std::fs::read_to_string(folder.path().join("tuned.toml")).unwrap();
    let value = |key: &str| {
        let line = tuned.lines().find(|line| line.starts_with(key));
        line.unwrap().rsplit(' ').next().unwrap().to_owned()
    };
    assert_eq!(value("creep_speed"), "9.0");
    let nominal = hitch_quantities::Calibration::nominal();
    let searched = value("approach_gain").parse::<f64>().unwrap();
    assert_ne!(searched, f64::from(nominal.position.approach_gain.0));
    // The reason is that of the default.
    let above = |key: &str| {
        let (before, _) = tuned.split_once(&format!("\n{key} = ")).unwrap();
        before.rsplit('\n').next().unwrap().to_owned()
    };
    let marked = above("approach_gain_per_s");
    assert!(
        marked.starts_with("# tuned (1 to 200); default 60: "),
        "{marked}"
    );
    assert!(
        above("creep_speed_mm_per_s").starts_with("# changed ("),
        "set by hand"
    );
    assert!(!above("restart_band_mm").contains("default"), "as it was");
    assert!(value("hysteresis_a").parse::<f64>().unwrap() >= 0.12);
}

#[test]
fn a_calibration_that_became_worse_is_written_only_by_force() {
    let folder = tempfile::tempdir().unwrap();
    // Only the hysteresis is searched, from far less than a real valve has: less of it is faster on these plants.
    let mut arguments = vec![
        "tune",
        "--scenario",
        "quick",
        "--trials",
        "10",
        "--out",
        "tuned.toml",
    ];
    let fixed: Vec<String> = hitch_results::tuning::KNOBS
        .iter()
        .filter(|knob| **knob != "hydraulics.hysteresis")
        .map(|knob| {
            let nominal = hitch_quantities::Calibration::nominal();
            let scalar = hitch_controller_host::calibration_file::scalar(&nominal, knob).unwrap();
            format!("{knob}={}", scalar.value)
        })
        .collect();
    std::fs::write(
        folder.path().join("low.toml"),
        "format = 1\n[hydraulics]\nhysteresis_a = 0.02\n",
    )
    .unwrap();
    arguments.extend(["--calibration", "low.toml"]);
    for setting in &fixed {
        arguments.extend(["--set", setting]);
    }
    let output = run(folder.path(), &arguments);
    let error = text(&output.stderr);
    println!("{}{error}", text(&output.stdout));
    assert_eq!(output.status.code(), Some(1), "{error}");
    // A slow machine says before it how far the search is.
    let mut faults = error.lines().filter(|line| line.starts_with("hitch: "));
    let is_said = faults
        .next()
        .is_some_and(|fault| fault.contains("tuned.toml is not written"));
    assert!(is_said && faults.next().is_none(), "{error}");
    assert!(!folder.path().join("tuned.toml").exists());
    arguments.push("--force");
    let forced = run(folder.path(), &arguments);
    assert!(forced.status.success(), "{}", text(&forced.stderr));
    assert!(folder.path().join("tuned.toml").exists());
}

/// The depth limit over an undulation is far from its requirement; what the search finds holds on a soil that it has not seen.
#[test]
fn tuning_a_function_of_the_field_helps_on_another_soil() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = "tune --scenario depth --trials 20 --out tuned.toml --report r.html --json -";
    let output = run(folder.path(), &arguments.split(' ').collect::<Vec<_>>());
    assert!(output.status.success(), "{}", text(&output.stderr));
    let document: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let depth = &document["figures"][1];
    println!("{depth}");
    let value = |key: &str| depth[key].as_f64().unwrap();
    assert!(value("before") > value("limit"));
    assert!(value("after") < 0.95 * value("before"));
    let report = std::fs::read_to_string(folder.path().join("r.html")).unwrap();
    assert_self_contained(&report);
    // The first of the soils of the search is that of the loop.
    let share = |more: &[&str]| {
        let arguments = [&["loop", "--scenario", "depth", "--json", "-"], more].concat();
        let output = run(folder.path(), &arguments);
        let document: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        document["field"][1]["value"].as_f64().unwrap()
    };
    assert!(share(&["--calibration", "tuned.toml"]) < share(&[]));
    let loads = "tune --scenario depth --loads 100 --out other.toml";
    let output = run(folder.path(), &loads.split(' ').collect::<Vec<_>>());
    assert_eq!(output.status.code(), Some(2));
}
