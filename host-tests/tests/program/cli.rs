//! The command line as scripts rely on it: names, JSON keys, where results go.
use std::fs;
use std::path::PathBuf;
use std::process::{Command, Stdio};

use host_tests::html_report::assert_self_contained;
use host_tests::program::{hitch, run};
use serde_json::Value;
use tempfile::TempDir;

use crate::small_campaign::campaign;

/// The one JSON document on standard output, of a command that has to succeed.
fn json(dir: &TempDir, arguments: &[&str]) -> Value {
    let output = run(dir.path(), arguments);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{arguments:?}: {said}");
    assert!(
        said.lines().all(is_progress),
        "{arguments:?}: only progress now and then: {said}"
    );
    serde_json::from_slice(&output.stdout).expect("one JSON document")
}

/// Whether a line reports progress with the elapsed time: where standard error is no terminal, a search writes one for
/// each better account, and a slow command one every ten seconds.
fn is_progress(line: &str) -> bool {
    let is_account = line.starts_with("best so far: ");
    let after = line.rsplit_once(" (").map(|(_, after)| after);
    let seconds = after.and_then(|after| after.strip_suffix(" s)"));
    seconds.is_some_and(|seconds| {
        let seconds = seconds.parse::<u32>();
        seconds.is_ok_and(|seconds| is_account || seconds >= 10)
    })
}

fn assert_keys(value: &Value, keys: &[&str]) {
    for key in keys {
        assert!(value.get(key).is_some(), "{key} is missing in {value}");
    }
}

const HEAD: [&str; 7] = [
    "campaign",
    "model",
    "error_before",
    "error_after",
    "noise_floor",
    "channels",
    "verdict",
];

#[test]
fn explain_tells_what_scripts_read() {
    let dir = campaign();
    let out = json(
        &dir,
        &[
            "explain", ".", "--json", "-", "--out", "m.toml", "--report", "r.html",
        ],
    );
    assert_keys(&out, &HEAD);
    assert_keys(&out, &["steps", "unexplained", "next_experiment"]);
    assert_keys(
        &out["channels"]["rocker_angle_deg"],
        &["before", "after", "noise", "late_s"],
    );
    assert_same_errors(&dir, &out["channels"]);
    assert_keys(
        &out["unexplained"],
        &["share", "depends_on", "suggested_term"],
    );
    let step = &out["steps"][0];
    assert_eq!(step["effect"], "lower-threshold-shift");
    assert_keys(
        step,
        &[
            "error_before",
            "error_after",
            "held_out_before",
            "held_out_after",
        ],
    );
    assert_keys(step, &["confidence", "indistinguishable", "detectability"]);
    assert_keys(
        &step["parameters"][0],
        &["name", "unit", "value", "low", "high"],
    );
    let shift_a = step["parameters"][0]["value"].as_f64().unwrap();
    assert!((shift_a / 0.199 - 1.0).abs() < 0.1, "{shift_a}");

    let model = fs::read_to_string(dir.path().join("m.toml")).unwrap();
    assert!(model.contains("id = \"lower-threshold-shift\""), "{model}");
    let after = json(&dir, &["compare", ".", "--model", "m.toml", "--json", "-"]);
    let error = after["error"].as_f64().unwrap();
    assert!(
        error < 1.1,
        "the written model explains the campaign: {error}"
    );
    let report = fs::read_to_string(dir.path().join("r.html")).unwrap();
    assert_self_contained(&report);
    assert!(report.contains("lower-threshold-shift"));
}

/// The initial errors by channel are those of `compare`: the weighted one, in sigma times the noise, and the raw one.
fn assert_same_errors(dir: &TempDir, channels: &Value) {
    let compared = json(dir, &["compare", ".", "--json", "-"]);
    for channel in compared["channels"].as_array().unwrap() {
        let number = |of: &Value, key: &str| of[key].as_f64().unwrap();
        let name = channel["channel"].as_str().unwrap();
        let explained = &channels[name];
        let weighted = number(channel, "error") * number(channel, "noise");
        for (key, compared) in [("before", weighted), ("rms_before", number(channel, "rms"))] {
            let ratio = number(explained, key) / compared;
            assert!((ratio - 1.0).abs() < 1e-9, "{name} {key}: {ratio}");
        }
    }
}

/// The command that a text proposes in its last line.
fn proposed(text: &str) -> Vec<String> {
    let last = text.lines().last().unwrap();
    let command = last.strip_prefix("  hitch ").expect("a command");
    command.split(' ').map(str::to_owned).collect()
}

#[test]
fn the_proposed_commands_lead_to_a_valve_map() {
    let dir = campaign();
    let mut command = vec!["compare".to_owned(), ".".to_owned()];
    let mut commands = Vec::new();
    while command[0] != "calibrate" {
        let arguments: Vec<&str> = command.iter().map(String::as_str).collect();
        let output = run(dir.path(), &arguments);
        assert!(output.status.success(), "{command:?}");
        commands.push(command[0].clone());
        command = proposed(&String::from_utf8(output.stdout).unwrap());
    }
    assert_eq!(commands, ["compare", "explain"]);
    let arguments: Vec<&str> = command.iter().map(String::as_str).collect();
    assert!(run(dir.path(), &arguments).status.success());
    assert!(dir.path().join("calibration.toml").exists());
}

#[test]
fn a_diagnosis_proposes_to_explain() {
    let output = run(campaign().path(), &["diagnose", ".", "--model", "nominal"]);
    let command = proposed(&String::from_utf8(output.stdout).unwrap());
    assert_eq!(command[..2], ["explain", "."]);
}

#[test]
fn diagnose_ranks_candidates() {
    let dir = campaign();
    let out = json(
        &dir,
        &["diagnose", ".", "--json", "-", "--report", "r.html"],
    );
    let report = fs::read_to_string(dir.path().join("r.html")).unwrap();
    assert_self_contained(&report);
    assert!(report.contains("+ lower-threshold-shift"));
    assert_keys(&out, &HEAD);
    let candidates = out["candidates"].as_array().unwrap();
    assert_eq!(candidates[0]["effect"], "lower-threshold-shift");
    for candidate in candidates {
        assert_keys(
            candidate,
            &[
                "effect",
                "explains",
                "error_after",
                "confidence",
                "indistinguishable",
                "detectability",
            ],
        );
    }
    let errors: Vec<f64> = candidates
        .iter()
        .map(|candidate| candidate["confidence"].as_f64().unwrap())
        .collect();
    assert!(errors[0] > 0.95, "{errors:?}");
}

#[test]
fn compare_shows_where_it_fails() {
    let out = json(&campaign(), &["compare", ".", "--json", "-"]);
    assert_keys(
        &out,
        &[
            "campaign",
            "model",
            "measurement",
            "error",
            "noise_floor",
            "channels",
            "cells",
            "worst",
        ],
    );
    let cells = out["cells"].as_array().unwrap();
    for by in ["regime", "current", "load", "temperature", "run"] {
        assert!(cells.iter().any(|cell| cell["by"] == by), "{by}");
    }
    let flow_while = |part: &str| {
        let cell = cells
            .iter()
            .find(|cell| cell["part"] == part && cell["channel"] == "flow_lpm");
        cell.unwrap()["error"].as_f64().unwrap()
    };
    assert!(
        flow_while("lowering") > 10.0 && flow_while("holding") < 1.2,
        "a lowering threshold shows while lowering"
    );
}

#[test]
fn add_estimates_and_writes_a_model() {
    let dir = campaign();
    let output = run(
        dir.path(),
        &[
            "add",
            "lower-threshold-shift",
            "--campaign",
            ".",
            "--out",
            "m.toml",
        ],
    );
    assert!(output.status.success());
    let model = fs::read_to_string(dir.path().join("m.toml")).unwrap();
    let value = model
        .lines()
        .find_map(|line| line.strip_prefix("shift_a = "))
        .unwrap();
    let shift_a: f64 = value.parse().unwrap();
    assert!((shift_a / 0.199 - 1.0).abs() < 0.1, "{shift_a}");
    let again = run(
        dir.path(),
        &[
            "add",
            "lower-threshold-shift",
            "--campaign",
            ".",
            "--model",
            "m.toml",
            "--out",
            "n.toml",
        ],
    );
    assert_eq!(again.status.code(), Some(2));
}

/// One duty cycle of a rig with a leak and a late sensor: what the leak comes to alone is not what it comes to beside
/// the lag.
fn one_duty_cycle() -> TempDir {
    let known = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("campaigns/known-leak-and-lag");
    let dir = TempDir::new().unwrap();
    let manifest = fs::read_to_string(known.join("campaign.toml")).unwrap();
    let (head, runs) = manifest.split_once("[[run]]").unwrap();
    let mut runs = runs.split("[[run]]");
    let run = runs.find(|run| run.contains("duty_150kg_18C")).unwrap();
    let manifest = format!("{head}[[run]]{run}");
    fs::write(dir.path().join("campaign.toml"), manifest).unwrap();
    let log = "duty_150kg_18C.csv";
    fs::copy(known.join(log), dir.path().join(log)).unwrap();
    dir
}

#[test]
fn the_only_run_is_validated_by_blocks_of_time() {
    let out = json(&one_duty_cycle(), &["explain", ".", "--json", "-"]);
    let steps = out["steps"].as_array().unwrap();
    assert!(!steps.is_empty(), "{out}");
    let first = &steps[0];
    let [before, after] =
        ["held_out_before", "held_out_after"].map(|key| first[key].as_f64().unwrap());
    assert!(after < before, "{before} to {after}");
    // A perfect model has an error of 1 on data that it was not fitted to.
    let last = steps.last().unwrap()["held_out_after"].as_f64().unwrap();
    assert!((0.8..1.3).contains(&last), "{last}");
}

#[test]
fn add_prints_the_values_that_it_writes() {
    let dir = one_duty_cycle();
    let arguments = "add lowering-leakage angle-sensor-lag --campaign . --out m.toml";
    let output = run(dir.path(), &arguments.split(' ').collect::<Vec<_>>());
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success(), "{said}");
    let model = fs::read_to_string(dir.path().join("m.toml")).unwrap();
    for (effect, parameter, key) in [
        (
            "lowering-leakage",
            "conductance ",
            "conductance_lpm_per_bar = ",
        ),
        ("angle-sensor-lag", "time_constant ", "time_constant_s = "),
    ] {
        let line = said.lines().find(|line| line.contains(effect)).unwrap();
        let printed = line.split(parameter).nth(1).unwrap();
        let printed: f64 = printed.split(' ').next().unwrap().parse().unwrap();
        let written = model.lines().find_map(|line| line.strip_prefix(key));
        let written: f64 = written
            .unwrap_or_else(|| panic!("{model}"))
            .parse()
            .unwrap();
        assert!((printed / written - 1.0).abs() < 1e-3, "{said}{model}");
        assert!(!line.contains("does not ask"), "{said}");
    }
}

#[test]
fn a_document_for_standard_output_is_alone_there() {
    let dir = campaign();
    let stdout = |arguments: &str| {
        let output = run(dir.path(), &arguments.split(' ').collect::<Vec<_>>());
        assert!(output.status.success(), "{output:?}");
        String::from_utf8(output.stdout).unwrap()
    };
    for (arguments, end) in [
        ("add lower-threshold-shift --campaign . --out", "m.toml"),
        ("explain . --out", "model.toml"),
        ("calibrate nominal --out", "c.toml"),
    ] {
        let document = stdout(&format!("{arguments} -"));
        assert!(!stdout(&format!("{arguments} {end}")).is_empty());
        let file = fs::read_to_string(dir.path().join(end)).unwrap();
        let name = |text: &str| text.replacen("\"m\"", "\"model\"", 1);
        assert_eq!(name(&document), name(&file), "{arguments}");
    }
    assert_self_contained(&stdout("compare . --report -"));
    assert!(!dir.path().join("-").exists());
}

#[test]
fn the_main_job_goes_from_measurements_to_motion() {
    let dir = TempDir::new().unwrap();
    let output = run(dir.path(), &["--report", "r.html"]);
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.contains("lower-threshold-shift"), "{text}");
    let pair = |name: &str| -> Vec<f64> {
        let line = text
            .lines()
            .find(|line| line.contains(name))
            .unwrap_or_else(|| panic!("{name} in {text}"));
        line.split_whitespace()
            .rev()
            .take(2)
            .map(|number| number.parse().unwrap())
            .collect()
    };
    let [rebuilt, nominal] = pair("lowering: time ratio, 95 % quantile")[..] else {
        panic!("two numbers")
    };
    assert!(
        rebuilt < nominal - 0.05,
        "the rebuilt map has to show: {nominal} to {rebuilt}"
    );
    let html = fs::read_to_string(dir.path().join("r.html")).unwrap();
    assert_self_contained(&html);
    assert!(
        html.contains("Closed loop"),
        "the report has the closed loop"
    );
}

#[test]
fn every_command_has_help_with_an_example() {
    let dir = TempDir::new().unwrap();
    let help = |arguments: &[&str]| {
        let output = run(dir.path(), arguments);
        assert!(
            output.status.success() && output.stderr.is_empty(),
            "{arguments:?}"
        );
        String::from_utf8(output.stdout).unwrap()
    };
    let all = help(&["--help"]);
    for command in [
        "compare", "diagnose", "add", "explain", "effects", "simulate",
    ] {
        assert!(
            all.contains(&format!("\n  {command} ")),
            "{command} in {all}"
        );
        let own = help(&[command, "--help"]);
        assert!(
            own.contains(&format!("hitch {command}")) && own.contains("Example"),
            "{own}"
        );
    }
}

#[test]
fn a_closed_pipe_is_no_error() {
    let mut child: std::process::Child = {
        let mut command: Command = hitch();
        command
            .args(["effects"])
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap()
    };
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(said.lines().all(is_progress), "{said}");
    assert!(output.status.success());
}

#[test]
fn the_ecu_picks_the_hitch_up_and_says_so() {
    let dir = TempDir::new().unwrap();
    let output = run(
        dir.path(),
        &["ecu", "--host", "--seconds", "1.2", "--flash", "flash.bin"],
    );
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success(), "{said}");
    // The first line has the headings. A note may follow the state, as on a machine that is behind real time.
    let mut lines = said.lines();
    let headings = lines.next().unwrap_or_default();
    let from = headings.find("state").expect("a heading of the state");
    let states: Vec<&str> = lines
        .filter_map(|line| line.get(from..)?.split_whitespace().next())
        .collect();
    assert_eq!(states.first(), Some(&"locked"), "{said}");
    assert_eq!(states.last(), Some(&"holding"), "{said}");
    assert_eq!(
        fs::metadata(dir.path().join("flash.bin")).unwrap().len(),
        14_336,
        "the flash is kept"
    );
}

#[test]
fn the_report_of_the_loop_shows_the_worst_cases_steps_and_what_was_set() {
    let dir = tempfile::tempdir().unwrap();
    let arguments = [
        "loop",
        "--scenario",
        "quick",
        "--set",
        "position.approach_gain=40",
        "--report",
        "l.html",
    ];
    let output = run(dir.path(), &arguments);
    assert!(output.status.success(), "{output:?}");
    let html = fs::read_to_string(dir.path().join("l.html")).unwrap();
    assert_self_contained(&html);
    for part in [
        "position.approach_gain=40",
        "Worst moves",
        "250 kg 40 °C",
        "Step responses over load",
        "Step responses over oil temperature",
        "Pressures of pump and cylinder",
    ] {
        assert!(html.contains(part), "no {part:?}");
    }
    // Two spans, up and down: one chart each over load, three for each of twelve moves.
    assert_eq!(html.matches("<figure>").count(), 4 + 3 * 12);
}
