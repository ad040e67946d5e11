//! From the tractor's bus to the model: what is hidden in a plant is found in a log of the ECU's bus.

use std::fmt::Write as _;
use std::fs;

use hitch_controller_host::calibration_file;
use hitch_ecu_host::ecu::{Bench, CutFlash, OnHost, Order, delivered};
use hitch_quantities::Calibration;
use host_tests::program::run;
use host_tests::teaching::dynamic_with;

const HIDDEN_A: f64 = 0.2;
const LOAD_KG: f64 = 150.0;
/// Where the operator moves the lever, s and degrees.
const MOVES: [(u32, f64); 4] = [(1, 90.0), (3, 110.0), (6, 70.0), (10, 100.0)];
const DURATION_S: u32 = 13;

/// Log of candump during operation of a hitch whose lowering valve opens later than the nominal one.
fn log(shift_a: f64, measured_period_ms: u32) -> String {
    let model = dynamic_with(&[("lower-threshold-shift", &[shift_a])]);
    let mut calibration = Calibration::nominal();
    let setting = format!("bus.measured_period={measured_period_ms}");
    calibration_file::set(&mut calibration, &setting).unwrap();
    let flash = delivered(&calibration.seal().unwrap());
    let mut machine = OnHost::start(CutFlash::holding(flash));
    let mut bench = Bench::new(&model, LOAD_KG, 40.0, 90.0, 1);
    let mut text = String::new();
    let mut said = Vec::new();
    for time_ms in 0..1_000 * DURATION_S {
        if let Some((_, lever_deg)) = MOVES.iter().find(|(at_s, _)| 1_000 * at_s == time_ms) {
            bench.operator.apply(Order::Lever(*lever_deg));
        }
        said.clear();
        bench.tick(&mut machine, &[], &mut said).unwrap();
        for frame in &said {
            let id = frame.extended_data_id().unwrap().as_raw();
            let data = frame.data().iter().map(|byte| format!("{byte:02X}"));
            let data: String = data.collect();
            let time_s = f64::from(time_ms) / 1e3;
            writeln!(text, "({time_s:.6}) can0 {id:08X}#{data}").unwrap();
        }
    }
    text
}

/// Output of `hitch explain` for such a log.
fn explained(shift_a: f64, measured_period_ms: u32) -> serde_json::Value {
    let dir = tempfile::tempdir().unwrap();
    let folder = dir.path().join("c");
    fs::create_dir(&folder).unwrap();
    let manifest = format!(
        "format = 1\n[[run]]\nfile = \"tractor.log\"\nbench = \"hitch\"\nload_kg = {LOAD_KG}\n"
    );
    fs::write(folder.join("campaign.toml"), manifest).unwrap();
    fs::write(folder.join("tractor.log"), log(shift_a, measured_period_ms)).unwrap();
    let output = run(
        dir.path(),
        &[
            "explain", "c", "--model", "dynamic", "--budget", "600", "--json", "-",
        ],
    );
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{said}");
    let found: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    println!(
        "{shift_a} A, every {measured_period_ms} ms: {}",
        found["verdict"]
    );
    for step in found["steps"].as_array().unwrap() {
        println!("  {} {}", step["effect"], step["parameters"]);
    }
    found
}

/// The size of the threshold's shift, which has to be named first, A.
fn shift_a(found: &serde_json::Value) -> f64 {
    let first = &found["steps"][0];
    assert_eq!(first["effect"], "lower-threshold-shift");
    first["parameters"][0]["value"].as_f64().unwrap()
}

#[test]
fn a_log_of_the_bus_names_what_is_hidden_in_the_plant() {
    let found = explained(HIDDEN_A, 5);
    let close_by = (shift_a(&found) - HIDDEN_A).abs() < 0.004;
    assert!(close_by && found["verdict"] == "explained");
    assert_eq!(found["steps"].as_array().unwrap().len(), 1);
    // A coil is cut within a millisecond, which samples every 20 ms do not resolve; the hidden effect still comes
    // first.
    let found = explained(HIDDEN_A, 20);
    assert!((shift_a(&found) - HIDDEN_A).abs() < 0.02);
}

#[test]
fn a_log_of_the_bus_names_nothing_if_nothing_is_hidden() {
    // Every sample of a current is a tenth of an ampere off with its dither: six effects were named for it.
    for period_ms in [5, 10] {
        let found = explained(0.0, period_ms);
        assert_eq!(found["verdict"], "nothing-missing");
    }
}
