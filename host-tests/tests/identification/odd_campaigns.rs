//! Valid but unusual campaigns: no command may fail, hang, or print anything but its document.
use std::fs;

use host_tests::program::run;
use serde_json::Value;
use tempfile::TempDir;

const ALL: &str = "time_s,lift_current_a,lower_current_a,pump_pressure_bar,cylinder_pressure_bar,flow_lpm,rocker_angle_deg";

/// A campaign of one run.
fn campaign(bench: &str, header: &str, rows: impl Iterator<Item = String>) -> TempDir {
    let dir = TempDir::new().unwrap();
    let manifest =
        format!("format = 1\nsample_rate_hz = 50\n[[run]]\nfile = \"run.csv\"\n{bench}\n");
    fs::write(dir.path().join("campaign.toml"), manifest).unwrap();
    let rows: Vec<String> = rows.collect();
    fs::write(
        dir.path().join("run.csv"),
        format!("{header}\n{}\n", rows.join("\n")),
    )
    .unwrap();
    dir
}

fn hitch(load_kg: f64) -> String {
    format!("bench = \"hitch\"\nload_kg = {load_kg}")
}

/// A lever pulled after a second.
fn pulled_a(i: usize) -> f64 {
    if i > 50 { 1.5 } else { 0.0 }
}

/// Numbers without any order, the same ones each time.
fn scattered(i: usize, column: usize) -> f64 {
    ((i * 7919 + column * 104_729 + 12_345) % 2_003) as f64 / 1001.5 - 1.0
}

/// Runs every reader on a campaign; returns the verdict on the nominal model.
fn explained(name: &str, dir: &TempDir) -> String {
    let mut verdict = String::new();
    for model in ["nominal", "dynamic"] {
        for command in ["compare", "explain"] {
            let output = run(
                dir.path(),
                &[
                    command, ".", "--model", model, "--json", "-", "--report", "r.html",
                ],
            );
            let said = String::from_utf8_lossy(&output.stderr).into_owned();
            assert!(
                output.status.success(),
                "{name}, {command}, {model}: {said}"
            );
            let document: Value =
                serde_json::from_slice(&output.stdout).expect("one JSON document");
            assert_eq!(document["model"], model, "{name}");
            let open = ["unexplained", "ambiguous", "not-enough-data"];
            let verdict_now = document["verdict"].as_str();
            if verdict_now.is_some_and(|word| open.contains(&word)) {
                let next = &document["next_experiment"];
                assert!(next.is_string(), "{name}, {model}: {verdict_now:?}");
            }
            if let (Some(word), "nominal") = (verdict_now, model) {
                word.clone_into(&mut verdict);
            }
        }
    }
    verdict
}

#[test]
fn nothing_happens() {
    let rest = |i: usize| format!("{:.2},0,0,4,11.5,0,90", i as f64 * 0.02);
    explained("rest", &campaign(&hitch(100.0), ALL, (0..200).map(rest)));
    explained(
        "ten samples",
        &campaign(&hitch(100.0), ALL, (0..10).map(rest)),
    );
}

#[test]
fn one_channel_only() {
    let row = |i: usize| {
        format!(
            "{:.2},{},0,{}",
            i as f64 * 0.02,
            pulled_a(i),
            60.0 + 0.1 * i.saturating_sub(50) as f64
        )
    };
    let header = "time_s,lift_current_a,lower_current_a,rocker_angle_deg";
    explained(
        "angle only",
        &campaign(&hitch(100.0), header, (0..200).map(row)),
    );
    let row = |i: usize| {
        format!(
            "{:.2},{},0,{}",
            i as f64 * 0.02,
            pulled_a(i),
            if i == 77 { "0.1" } else { "" }
        )
    };
    let header = "time_s,lift_current_a,lower_current_a,flow_lpm";
    explained(
        "one sample of flow",
        &campaign(&hitch(100.0), header, (0..200).map(row)),
    );
}

#[test]
fn numbers_without_sense() {
    let row = |i: usize| {
        let value = |column: usize, size: f64| size * scattered(i, column);
        let pressures = format!("{},{}", value(3, 500.0).abs(), value(4, 500.0).abs());
        format!(
            "{:.2},{},{},{pressures},{},{}",
            i as f64 * 0.02,
            value(1, 10.0),
            value(2, 10.0),
            value(5, 900.0),
            value(6, 360.0)
        )
    };
    explained("hitch", &campaign(&hitch(0.0), ALL, (0..150).map(row)));
    explained(
        "overload",
        &campaign(&hitch(2000.0), ALL, (0..150).map(row)),
    );
    explained(
        "flow bench",
        &campaign(
            "bench = \"flow\"\nport_pressure_bar = 400",
            ALL,
            (0..150).map(row),
        ),
    );
}

#[test]
fn clocks_without_sense() {
    let at = |time_s: String, i: usize| format!("{time_s},{},0,4,11.5,0,90", pulled_a(i));
    let since_1970 = |i: usize| at(format!("{:.2}", 1.7e9 + i as f64 * 0.02), i);
    explained(
        "time since 1970",
        &campaign(&hitch(100.0), ALL, (0..150).map(since_1970)),
    );
    let picoseconds = |i: usize| at(format!("{:.13}", i as f64 * 1e-12), i);
    explained(
        "picoseconds",
        &campaign(&hitch(100.0), ALL, (0..150).map(picoseconds)),
    );
}

/// Each subset of the measured channels of a lift: also an angle alone, which determines no constant.
#[test]
fn every_subset_of_channels_is_compared_and_fitted() {
    let channels: Vec<&str> = ALL.split(',').skip(3).collect();
    let row = |i: usize| {
        let lifted = i.saturating_sub(50) as f64;
        let noise = |channel: usize, sigma: f64| sigma * scattered(i, channel);
        [
            if i > 50 { 20.0 } else { 4.0 } + noise(0, 0.3),
            11.5 + noise(1, 0.2),
            if i > 50 { 6.0 } else { 0.0 } + noise(2, 0.1),
            60.0 + 0.1 * lifted + noise(3, 0.05),
        ]
    };
    for subset in 1..1 << channels.len() {
        let picked = |k: &usize| subset >> k & 1 == 1;
        let picked: Vec<usize> = (0..channels.len()).filter(picked).collect();
        let names: Vec<&str> = picked.iter().map(|&k| channels[k]).collect();
        let header = format!("time_s,lift_current_a,lower_current_a,{}", names.join(","));
        let rows = (0..150).map(|i| {
            let values = picked.iter().map(|&k| format!("{:.3}", row(i)[k]));
            let values: Vec<String> = values.collect();
            format!(
                "{:.2},{},0,{}",
                i as f64 * 0.02,
                pulled_a(i),
                values.join(",")
            )
        });
        let dir = campaign(&hitch(100.0), &header, rows);
        for arguments in [
            &["compare", ".", "--json", "-"][..],
            &["model", "fit", ".", "--out", "fitted.toml"],
        ] {
            let output = run(dir.path(), arguments);
            let said = String::from_utf8_lossy(&output.stderr).into_owned();
            assert!(output.status.success(), "{names:?}, {arguments:?}: {said}");
        }
    }
}
