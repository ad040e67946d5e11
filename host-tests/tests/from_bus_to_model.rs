//! From the tractor's bus to the model: what is hidden in a plant is found in a log of the ECU's bus.

use std::fmt::Write as _;
use std::fs;

use hitch_firmware::control::Calibration;
use hitch_workbench::calibration_file;
use hitch_workbench::ecu::{Bench, CutFlash, OnHost, Order, delivered};
use host_tests::program::run;
use host_tests::teaching::dynamic_with;

const HIDDEN_A: f64 = 0.2;
const LOAD_KG: f64 = 150.0;
/// Where the operator moves the lever, s and degrees.
const MOVES: [(u32, f64); 4] = [(1, 90.0), (3, 110.0), (6, 70.0), (10, 100.0)];
const DURATION_S: u32 = 13;

/// What candump logs while the operator works on a hitch whose lowering valve opens later than the nominal one.
fn log(measured_period_ms: u32) -> String {
    let model = dynamic_with(&[("lower-threshold-shift", &[HIDDEN_A])]);
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
            bench.operator.obey(Order::Lever(*lever_deg));
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

/// The size of the threshold's shift that `hitch explain` finds first, A, the number of effects, and the verdict.
fn explained(measured_period_ms: u32) -> (f64, usize, String) {
    let dir = tempfile::tempdir().unwrap();
    let folder = dir.path().join("c");
    fs::create_dir(&folder).unwrap();
    let manifest = format!(
        "format = 1\n[[run]]\nfile = \"tractor.log\"\nbench = \"hitch\"\nload_kg = {LOAD_KG}\n"
    );
    fs::write(folder.join("campaign.toml"), manifest).unwrap();
    fs::write(folder.join("tractor.log"), log(measured_period_ms)).unwrap();
    let output = run(
        dir.path(),
        &["explain", "c", "--model", "dynamic", "--json", "-"],
    );
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{said}");
    let found: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let steps = found["steps"].as_array().unwrap();
    println!(
        "every {measured_period_ms} ms: {:?}, error {} to {}, {}",
        steps.iter().map(|step| &step["effect"]).collect::<Vec<_>>(),
        found["error_before"],
        found["error_after"],
        found["verdict"]
    );
    assert_eq!(steps[0]["effect"], "lower-threshold-shift");
    let shift_a = steps[0]["parameters"][0]["value"].as_f64().unwrap();
    println!("shift {shift_a} A");
    let verdict = found["verdict"].as_str().unwrap().to_owned();
    (shift_a, steps.len(), verdict)
}

#[test]
fn a_log_of_the_bus_names_what_is_hidden_in_the_plant() {
    let (shift_a, effects, verdict) = explained(5);
    assert!((shift_a - HIDDEN_A).abs() < 0.004, "{shift_a} A");
    assert_eq!((effects, verdict.as_str()), (1, "explained"));
    // A coil is cut within a millisecond, of which samples every 20 ms know little; what is hidden still comes first.
    let (shift_a, _, _) = explained(20);
    assert!((shift_a - HIDDEN_A).abs() < 0.02, "{shift_a} A");
}
