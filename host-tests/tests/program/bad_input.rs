//! Bad input, through the program itself: one clear line, exit code 2, no output file, nothing on standard output.
use std::fs;

use host_tests::program::hitch;
use host_tests::refusal::{MANIFEST, folder, log, refused, write};

/// Every command that reads a campaign, with every output file that it can write.
const READERS: [&[&str]; 4] = [
    &["compare", "c", "--report", "out.html", "--json", "out.json"],
    &["diagnose", "c", "--json", "out.json"],
    &[
        "explain", "c", "--report", "out.html", "--out", "out.toml", "--json", "out.json",
    ],
    &[
        "add",
        "coulomb-friction",
        "--campaign",
        "c",
        "--out",
        "out.toml",
    ],
];

#[test]
fn every_reader_of_campaigns_refuses_a_bad_one() {
    let dir = folder();
    write(&dir, "c/lift.csv", log().replacen(",4.0,", ",NaN,", 1));
    for arguments in READERS {
        refused(
            dir.path(),
            arguments,
            "c/lift.csv:2:14: \"NaN\" in column \"pump_pressure_bar\" is not a number",
        );
    }
}

#[test]
fn every_reader_of_campaigns_refuses_a_bad_log_of_a_bus() {
    let dir = folder();
    write(
        &dir,
        "c/campaign.toml",
        MANIFEST.replace("lift.csv", "bus.asc"),
    );
    write(&dir, "c/bus.asc", " 0.5 1 18FF4580x Rx d 2 0A\n");
    for arguments in READERS {
        let cut = "c/bus.asc:1:27: the line ends before its last byte; delete the truncated line";
        refused(dir.path(), arguments, cut);
    }
}

// REQ-INPUT-01
#[test]
fn bad_logs_are_refused_by_line_and_column() {
    let log = log();
    let cases = [
        (
            log.replacen("0.04,", "0.01,", 1),
            "c/lift.csv:4:1: time goes back",
        ),
        (
            log.replacen("0.04,", "0.02,", 1),
            "c/lift.csv:4:1: time stands still",
        ),
        (
            log.replacen(",16.0,", ",sixteen,", 1),
            "c/lift.csv:2:18: \"sixteen\" in column \"cylinder_pressure_bar\"",
        ),
        (
            log.replacen(",16.0,", ",inf,", 1),
            "c/lift.csv:2:18: \"inf\" in column \"cylinder_pressure_bar\" is not a number",
        ),
        (
            log.replacen("rocker_angle_deg", "rocker_angle_rad", 1),
            "unit rad is not known, this column has to be rocker_angle_deg",
        ),
        (
            log.replacen("lower_current_a", "flow_lpm", 1),
            "c/lift.csv:1:72: column flow_lpm is duplicated",
        ),
        (
            log.replacen(",lower_current_a", "", 1)
                .replace(",0.0,4.0", ",4.0"),
            "column lower_current_a is missing",
        ),
        (
            log.replacen(",90.0", "", 1),
            "c/lift.csv:2:1: the row has 6 cells, the header has 7",
        ),
        (
            log.lines().next().unwrap().to_owned(),
            "contains a header but no samples",
        ),
        (String::new(), "c/lift.csv: is empty"),
        (
            "time_s,lift_current_a,lower_current_a\n".to_owned() + &currents_only(),
            "has no usable channel",
        ),
    ];
    for (text, expected) in cases {
        let dir = folder();
        write(&dir, "c/lift.csv", text);
        refused(dir.path(), &["compare", "c", "--json", "-"], expected);
    }
}

fn currents_only() -> String {
    (0..100)
        .map(|i| format!("{:.2},0,0\n", f64::from(i) * 0.02))
        .collect()
}

// REQ-INPUT-01
#[test]
fn bad_manifests_are_refused_by_line_and_column() {
    let cases = [
        (
            MANIFEST.replace("lift.csv", "left.csv"),
            "c/campaign.toml:6:8: the folder contains no file \"left.csv\"",
        ),
        (
            MANIFEST.replace("load_kg", "load_lb"),
            "c/campaign.toml:8:1: unit lb is not known, this key has to be load_kg",
        ),
        (
            MANIFEST.replace("load_kg = 150", "load_kg = -150"),
            "c/campaign.toml:8:11: load_kg = -150 is out of range",
        ),
        (
            MANIFEST.replace("name =", "title ="),
            "c/campaign.toml:2:1: key \"title\" is not known",
        ),
        (
            MANIFEST.replace("format = 1", "format = 9"),
            "c/campaign.toml:1:10: format 9 is not known",
        ),
        (MANIFEST.replace("[[run]]", "[[run]"), "c/campaign.toml:5:"),
        (
            MANIFEST.split("[[run]]").next().unwrap().to_owned(),
            "the campaign has no runs",
        ),
    ];
    for (text, expected) in cases {
        let dir = folder();
        write(&dir, "c/campaign.toml", text);
        refused(
            dir.path(),
            &["compare", "c", "--report", "out.html"],
            expected,
        );
    }
}

#[test]
fn missing_campaigns_are_refused() {
    let dir = folder();
    refused(
        dir.path(),
        &["compare", "empty"],
        "empty: contains no campaign.toml",
    );
    refused(
        dir.path(),
        &["compare", "nowhere"],
        "nowhere: no such folder",
    );
    refused(
        dir.path(),
        &["compare", "log.csv"],
        "log.csv: is not a folder",
    );
    fs::remove_file(dir.path().join("c/lift.csv")).unwrap();
    refused(
        dir.path(),
        &["explain", "c", "--out", "out.toml"],
        "the folder contains no file \"lift.csv\"",
    );
}

// REQ-INPUT-01
#[test]
fn bad_models_are_refused_by_line_and_column() {
    let base = "format = 1\nbase = \"nominal\"\n";
    let cases = [
        (
            format!("{base}[relief_valve]\nset_pressure_psi = 2200\n"),
            "m.toml:4:1: unit psi is not known, this key has to be set_pressure_bar",
        ),
        (
            format!("{base}[relief_valve]\nset_presure_bar = 154\n"),
            "did you mean set_pressure_bar?",
        ),
        (
            format!("{base}[relief_valve]\nset_pressure_bar = \"high\"\n"),
            "m.toml:4:20: set_pressure_bar has to be a number",
        ),
        (
            format!("{base}[relief_valve]\nset_pressure_bar = -1\n"),
            "m.toml:4:20: set_pressure_bar = -1 is out of range",
        ),
        (
            format!("{base}[[effect]]\nid = \"coulomb-fricton\"\n"),
            "did you mean coulomb-friction?",
        ),
        (
            format!("{base}[[effect]]\nid = \"lower-threshold-shift\"\nshift_ma = 200\n"),
            "m.toml:5:1: unit ma is not known, this key has to be shift_a",
        ),
        (
            format!("{base}[linkage]\nlift_rod_m = 0.01\n"),
            "m.toml:4:14: lift_rod_m: the lift rod of 0.01 m cannot join",
        ),
        (
            format!("{base}[cylinder]\nstroke_mm = 1000\n"),
            "m.toml:4:13: stroke_mm: a rocker arm of 0.11 m",
        ),
        (
            format!("{base}[linkage]\nconnecting_rod_m = 0.01\n"),
            "m.toml:4:20: connecting_rod_m: the connecting rod of 0.01 m does not reach",
        ),
        (
            format!("{base}[[effect]]\nid = \"no-such-effect\"\n"),
            "lift-flow-scale, lower-flow-scale, solenoid-hysteresis, ",
        ),
        ("format = 1\n".to_owned(), "has no dynamics"),
        ("[[[".to_owned(), "m.toml:1:"),
    ];
    for (text, expected) in cases {
        let dir = folder();
        write(&dir, "m.toml", text);
        refused(
            dir.path(),
            &["compare", "c", "--model", "m.toml", "--report", "out.html"],
            expected,
        );
        refused(
            dir.path(),
            &[
                "simulate", "--model", "m.toml", "--inputs", "log.csv", "--out", "out.csv",
            ],
            expected,
        );
    }
    refused(
        folder().path(),
        &["compare", "c", "--model", "nominall"],
        "nominall: no such model",
    );
}

// REQ-INPUT-01
#[test]
fn bad_calibrations_are_refused_by_line_and_column() {
    let cases = [
        (
            "format = 1\n[lift]\ncurrent_ma = [1100]\n",
            "c.toml:3:1: unit ma is not known, this key has to be current_a",
        ),
        (
            "format = 1\n[lifting]\n",
            "c.toml:2:2: key \"lifting\" is not known",
        ),
        ("format = 2\n", "c.toml:1:10: "),
        (
            "format = 1\n[lift]\ncurrent_a = [2.0, 1.0]\nflow_lpm = [0.0, 10.0]\n",
            "c.toml",
        ),
    ];
    for (text, expected) in cases {
        let dir = folder();
        write(&dir, "c.toml", text);
        refused(
            dir.path(),
            &["loop", "--calibration", "c.toml", "--report", "out.html"],
            expected,
        );
        refused(
            dir.path(),
            &["controller", "--calibration", "c.toml"],
            expected,
        );
    }
    let dir = folder();
    write(
        &dir,
        "m.toml",
        "format = 1\nbase = \"nominal\"\n[relief_valve]\nset_pressure_psi = 2200\n",
    );
    refused(
        dir.path(),
        &["calibrate", "m.toml", "--out", "c.toml"],
        "m.toml:4:1: unit psi is not known",
    );
    refused(
        dir.path(),
        &["loop", "--model", "m.toml", "--json", "-"],
        "m.toml:4:1: unit psi is not known",
    );
}

// REQ-INPUT-01
#[test]
fn bad_command_lines_are_refused() {
    let dir = folder();
    let cases: [(&[&str], &str); 10] = [
        (&["explane", "c"], "a similar subcommand exists: 'explain'"),
        (&["explain"], "<CAMPAIGN>"),
        (
            &["explain", "c", "--reprot", "x"],
            "a similar argument exists: '--report'",
        ),
        (&["effects", "coulomb"], "did you mean coulomb-friction?"),
        (
            &[
                "add",
                "no-such-effect",
                "--campaign",
                "c",
                "--out",
                "out.toml",
            ],
            "effect \"no-such-effect\" is not known; known: ",
        ),
        (
            &[
                "add",
                "coulomb-friction",
                "coulomb-friction",
                "--campaign",
                "c",
                "--out",
                "out.toml",
            ],
            "is in the model already",
        ),
        (
            &["add", "coulomb-friction", "--campaign", "c"],
            "--out <MODEL.toml>",
        ),
        (
            &["explain", "c", "--out", "nowhere/out.toml"],
            "nowhere/out.toml: cannot be written: its folder does not exist",
        ),
        (
            &[
                "simulate", "--inputs", "log.csv", "--load", "-5", "--out", "out.csv",
            ],
            "the range is 0 to 20000",
        ),
        (
            &["simulate", "--inputs", "gone.csv", "--out", "out.csv"],
            "gone.csv: no such file",
        ),
    ];
    for (arguments, expected) in cases {
        refused(dir.path(), arguments, expected);
    }
}

#[test]
fn a_start_beyond_the_stroke_is_refused() {
    let start = "simulate --inputs log.csv --out out.csv --start-angle 10";
    let said = "--start-angle 10: the stroke goes from 44.1 to 135.9 degrees; name an angle";
    refused(folder().path(), &start.split(' ').collect::<Vec<_>>(), said);
}

#[test]
fn an_ecu_without_what_it_needs() {
    let dir = folder();
    let folder = dir.path();
    refused(folder, &["ecu", "--load", "-5"], "0 to 20000");
    refused(folder, &["ecu", "--model", "no.toml"], "no.toml");
    refused(folder, &["ecu", "--can", "nowhere"], "127.0.0.1:7701");
    refused(
        folder,
        &["ecu", "--flash", "log.csv"],
        "not the flash of an ECU",
    );
    refused(folder, &["ecu", "--image", "no-image"], "--host");
}

#[test]
fn an_ecu_without_an_emulator_says_what_to_install() {
    let dir = folder();
    let output = hitch()
        .args(["ecu", "--seconds", "0"])
        .current_dir(dir.path())
        .env("PATH", dir.path())
        .output()
        .unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("apt-get install qemu-system-arm"), "{said}");
    assert!(said.contains("--host"), "{said}");
}
