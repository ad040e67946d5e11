//! `--next`: the proposed experiment as files for a test stand, until its logs are a campaign.

use std::fs;

use host_tests::program::run;
use serde_json::Value;

use crate::small_campaign::campaign;

/// The currents in the files are those of the document; with the logs saved beside the manifest, the folder is a campaign.
#[test]
fn the_files_of_the_next_experiment_become_a_campaign() {
    let dir = campaign();
    let log = dir.path().join("lower_2.2A_150kg.csv");
    fs::write(&log, with_a_swing(&fs::read_to_string(&log).unwrap())).unwrap();
    let diagnose = [
        "diagnose", ".", "--json", "-", "--next", "next", "--report", "d.html",
    ];
    let out = run(dir.path(), &diagnose);
    assert!(out.status.success(), "{out:?}");
    let document: Value = serde_json::from_slice(&out.stdout).unwrap();
    let runs = document["next_experiment_detail"]["runs"]
        .as_array()
        .unwrap();
    assert!(!runs.is_empty());
    let next = dir.path().join("next");
    let manifest = fs::read_to_string(next.join("campaign.toml")).unwrap();
    let files: Vec<&str> = manifest
        .lines()
        .filter_map(|line| line.strip_prefix("file = \"")?.strip_suffix('"'))
        .collect();
    assert_eq!(files.len(), runs.len());
    assert_eq!(
        run(dir.path(), &["compare", "next"]).status.code(),
        Some(2),
        "nothing is logged yet"
    );
    for (file, planned) in files.iter().zip(runs) {
        let currents = fs::read_to_string(next.join("currents").join(file)).unwrap();
        let column = |at: usize| {
            let lines = currents.lines().skip(1);
            lines.map(move |line| line.split(',').nth(at).unwrap().parse::<f64>().unwrap())
        };
        let duration_s = planned["duration_s"].as_f64().unwrap();
        assert!((column(0).last().unwrap() - duration_s).abs() < 0.011);
        for (at, key) in [(1, "lift_current_a"), (2, "lower_current_a")] {
            let segments = planned["currents"].as_array().unwrap().iter();
            let most = segments
                .map(|one| one[key].as_f64().unwrap())
                .fold(0.0, f64::max);
            let written = column(at).fold(0.0, f64::max);
            assert!(
                (written - most).abs() < 1e-3,
                "{file} {key}: {written} A, planned {most} A"
            );
        }
        let stand = match planned["load_kg"].as_f64() {
            Some(kg) => ["--load".to_owned(), kg.to_string()],
            None => [
                "--port-pressure".to_owned(),
                planned["port_pressure_bar"].to_string(),
            ],
        };
        let (from, to) = (format!("next/currents/{file}"), format!("next/{file}"));
        let simulate = [
            "simulate", "--inputs", &from, "--out", &to, &stand[0], &stand[1],
        ];
        let out = run(dir.path(), &simulate);
        assert!(out.status.success(), "{out:?}");
    }
    assert!(run(dir.path(), &["compare", "next"]).status.success());
    let report = fs::read_to_string(dir.path().join("d.html")).unwrap();
    assert!(report.contains("The next experiment"));
    let again = run(dir.path(), &diagnose);
    assert_eq!(again.status.code(), Some(2), "the logs are not overwritten");
}

/// A log with 4 bar at 1 Hz on its cylinder pressure, which no effect of the catalogue explains.
fn with_a_swing(log: &str) -> String {
    let mut lines = log.lines();
    let header = lines.next().unwrap();
    let place = |key: &str| header.split(',').position(|name| name == key).unwrap();
    let (time, pressure) = (place("time_s"), place("cylinder_pressure_bar"));
    let mut text = format!("{header}\n");
    for line in lines {
        let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
        let time_s: f64 = cells[time].parse().unwrap();
        let bar: f64 = cells[pressure].parse().unwrap();
        cells[pressure] = format!("{:.3}", bar + 4.0 * (std::f64::consts::TAU * time_s).sin());
        text += &format!("{}\n", cells.join(","));
    }
    text
}
