//! `hitch loop`: moves that never arrive, oil temperatures, and the buttons.

use std::path::Path;

use host_tests::program::run;
use serde_json::Value;

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// The document of `hitch loop`, which has to succeed.
fn document(folder: &Path, options: &str) -> Value {
    let arguments = format!("loop {options} --json -");
    let output = run(folder, &arguments.split(' ').collect::<Vec<_>>());
    assert!(output.status.success(), "{}", text(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

#[test]
fn a_move_that_never_arrives_is_an_error_with_its_cause_after_the_table() {
    let folder = tempfile::tempdir().unwrap();
    let map = "format = 1\n[position]\nupper_limit_deg = 95\n";
    std::fs::write(folder.path().join("limited.toml"), map).unwrap();
    let leak = hitch_effects::find("lowering-leakage").expect("in the catalogue");
    let mut leak = hitch_plant::AddedEffect::typical(leak);
    leak.values[0] = 0.03;
    let leaking = hitch_model_file::dynamic().with_effects(vec![leak]);
    std::fs::write(
        folder.path().join("leaking.toml"),
        hitch_model_file::to_toml(&leaking),
    )
    .unwrap();
    for (more, cause) in [
        ("--load 2000", "the pump cannot lift this load"),
        (
            "--load 150 --calibration limited.toml",
            "limits the set point to 95.0 deg",
        ),
        // The fault is over at the end: the controller is locked.
        ("--load 250 --model leaking.toml", "reports `sinking`"),
    ] {
        let arguments = format!("loop --scenario quick {more}");
        let output = run(folder.path(), &arguments.split(' ').collect::<Vec<_>>());
        let (table, error) = (text(&output.stdout), text(&output.stderr));
        println!("{table}{error}");
        assert_eq!(output.status.code(), Some(2), "{error}");
        assert!(table.contains("moves never arrived"), "{table}");
        assert_eq!(error.lines().count(), 1, "{error}");
        assert!(
            error.contains(" never arrives (") && error.contains(cause),
            "{error}"
        );
    }
}

#[test]
fn oil_temperatures_of_the_moves_are_chosen() {
    let folder = tempfile::tempdir().unwrap();
    let document = document(
        folder.path(),
        "--scenario quick --loads 50,150 --oil-temperatures=10,70",
    );
    let moves = document["moves"].as_array().unwrap();
    assert_eq!(moves.len(), 2 * 2 * 4);
    let time_s = |load_kg: f64, oil_c: f64| {
        let of = |result: &&Value| {
            result["load_kg"] == load_kg
                && result["oil_temperature_c"] == oil_c
                && result["to_deg"].as_f64() > result["from_deg"].as_f64()
        };
        moves
            .iter()
            .filter(of)
            .map(|one| one["time_s"].as_f64().unwrap())
            .sum::<f64>()
    };
    for load_kg in [50.0, 150.0] {
        let (cold, hot) = (time_s(load_kg, 10.0), time_s(load_kg, 70.0));
        println!("{load_kg} kg: lifts take {cold:.3} s with cold oil, {hot:.3} s with hot oil");
        assert!(cold > 0.0 && hot > 0.0 && cold != hot);
    }
    for bad in ["hot", "200", ""] {
        let output = run(folder.path(), &["loop", "--oil-temperatures", bad]);
        assert_eq!(output.status.code(), Some(2), "{bad}");
        assert!(output.stdout.is_empty());
    }
}

// REQ-MODE-03
#[test]
fn the_button_is_driven_in_both_directions_at_its_speeds() {
    let folder = tempfile::tempdir().unwrap();
    let document = document(folder.path(), "--scenario rate --oil-temperatures 10,40,70");
    let presses = document["presses"].as_array().unwrap();
    assert_eq!(presses.len(), 3 * 3 * 3 * 2);
    for press in presses {
        let figure = |name: &str| {
            press[name]
                .as_f64()
                .unwrap_or_else(|| panic!("{name}: {press}"))
        };
        assert!((figure("speed_ratio") - 1.0).abs() < 0.05, "{press}");
        assert!(
            figure("start_delay_s") > 0.0 && figure("start_delay_s") < 1.0,
            "{press}"
        );
        assert!(
            figure("stop_delay_s") >= 0.0 && figure("stop_delay_s") < 2.0,
            "{press}"
        );
    }
    // A slower ramp starts later.
    let start_s = |options: &str| {
        let output = run(folder.path(), &options.split(' ').collect::<Vec<_>>());
        let document: Value = serde_json::from_slice(&output.stdout).unwrap();
        document["presses"][4]["start_delay_s"].as_f64().unwrap()
    };
    let usual_s = start_s("loop --scenario rate --load 150 --json -");
    let slow_s = start_s("loop --scenario rate --load 150 --set rate.rate_slope=10 --json -");
    println!("half of 15 deg/s after {usual_s} s; with a third of the slope after {slow_s} s");
    assert!(slow_s > usual_s + 0.3);
    let refused = run(
        folder.path(),
        &["loop", "--scenario", "rate", "--report", "r.html"],
    );
    assert_eq!(refused.status.code(), Some(2));
    assert!(!folder.path().join("r.html").exists());
}

// REQ-MODE-10
#[test]
fn quick_lift_raises_and_returns_to_the_lever_without_overshoot() {
    let folder = tempfile::tempdir().unwrap();
    let document = document(folder.path(), "--scenario quick-lift");
    let moves = document["moves"].as_array().unwrap();
    assert_eq!(moves.len(), 3 * 3 * 2);
    let raised_deg = f64::from(
        hitch_quantities::Calibration::nominal()
            .operator
            .quick_lift_angle
            .0,
    ) * 1e-3;
    for pair in moves.chunks(2) {
        assert_eq!(pair[0]["to_deg"], raised_deg, "{}", pair[0]);
        assert_eq!(pair[1]["from_deg"], raised_deg, "{}", pair[1]);
        assert_eq!(pair[0]["from_deg"], pair[1]["to_deg"]);
        for driven in pair {
            assert_eq!(driven["arrived"], true, "{driven}");
            assert!(driven["overshoot_deg"].as_f64().unwrap() < 0.3, "{driven}");
            assert!(driven["ratio"].as_f64().unwrap() < 1.5, "{driven}");
        }
    }
}
