//! Recording from the ECU and writing calibrations to it, with the commands of the program.

use std::io::Write;
use std::process::Stdio;
use std::thread::sleep;
use std::time::Duration;

use hitch_campaign::Campaign;
use hitch_ecu_host::ecu::CutFlash;
use hitch_protocols::storage::CalibrationStore;
use host_tests::program::{hitch, run};

use crate::running_ecu::{RunningEcu, said};

#[test]
fn a_campaign_is_recorded_and_a_calibration_comes_back_from_flash() {
    let dir = tempfile::tempdir().unwrap();
    let folder = dir.path();
    std::fs::write(
        folder.join("c.toml"),
        "format = 1\n[position]\napproach_gain_per_s = 33\n",
    )
    .unwrap();
    let mut ecu = RunningEcu::start(folder);
    let bus = ecu.bus.clone();
    // Picked up after half a second, and then at rest.
    sleep(Duration::from_millis(1_200));
    let recorder = hitch()
        .args(["record", "--can", &bus, "--out", "c", "--load", "150"])
        .args(["--temperature", "40", "--seconds", "3"])
        .current_dir(folder)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    sleep(Duration::from_millis(800));
    ecu.order("lever 105");
    let recorded = recorder.wait_with_output().unwrap();
    assert!(recorded.status.success(), "{}", said(&recorded));
    let campaign = Campaign::load(&folder.join("c")).unwrap();
    assert_eq!(campaign.runs.len(), 1);
    let log = std::fs::read_to_string(folder.join("c/run_01.csv")).unwrap();
    let angles_deg: Vec<f64> = log
        .lines()
        .skip(1)
        .map(|row| row.rsplit(',').next().unwrap().parse().unwrap())
        .collect();
    assert!(angles_deg.len() >= 145, "{} samples", angles_deg.len());
    assert!((angles_deg[0] - 90.0).abs() < 0.5, "{}", angles_deg[0]);
    let last_deg = angles_deg[angles_deg.len() - 1];
    assert!((last_deg - 105.0).abs() < 0.5, "{last_deg}");

    let write = ["flash-calibration", "c.toml", "--can", &bus];
    let refused = run(folder, &write);
    assert_eq!(refused.status.code(), Some(2), "{}", said(&refused));
    assert!(said(&refused).contains("service on"), "{}", said(&refused));
    ecu.order("service on");
    ecu.order("lock on");
    sleep(Duration::from_millis(100));
    let written = run(folder, &write);
    assert!(written.status.success(), "{}", said(&written));
    assert!(said(&written).contains("1 of "), "{}", said(&written));
    ecu.quit();
    let flash = CutFlash::holding(std::fs::read(folder.join("flash.bin")).unwrap());
    let stored = CalibrationStore::new(flash).load().calibration;
    assert_eq!(stored.position.approach_gain.0, 33);
}

#[test]
fn a_safety_value_becomes_looser_with_the_key_only() {
    let dir = tempfile::tempdir().unwrap();
    let folder = dir.path();
    let calibration = |name: &str, open_time_ms: u32| {
        let text = format!("format = 1\n[safety]\nopen_time_ms = {open_time_ms}\n");
        std::fs::write(folder.join(name), text).unwrap();
    };
    calibration("tight.toml", 30);
    calibration("loose.toml", 44);
    let digits = |first: char| format!("{first}{}\n", "1f".repeat(32).split_off(1));
    std::fs::write(folder.join("key.txt"), digits('3')).unwrap();
    std::fs::write(folder.join("wrong.txt"), digits('2')).unwrap();
    let mut ecu = RunningEcu::start_with(folder, &["--key", "key.txt"]);
    ecu.order("service on");
    ecu.order("lock on");
    sleep(Duration::from_millis(1_000));
    let write = |file: &str, key: &[&str]| {
        let command = ["flash-calibration", file, "--can", &ecu.bus];
        run(folder, &[&command, key].concat())
    };
    let refused = write("loose.toml", &[]);
    assert_eq!(refused.status.code(), Some(2), "{}", said(&refused));
    let line = said(&refused);
    assert!(
        line.contains("safety.open_time") && line.contains("--key"),
        "{line}"
    );
    assert_eq!(line.trim().lines().count(), 1, "{line}");
    let written = write("tight.toml", &[]);
    assert!(written.status.success(), "{}", said(&written));
    let written = write("loose.toml", &["--key", "key.txt"]);
    assert!(written.status.success(), "{}", said(&written));
    assert!(write("tight.toml", &[]).status.success());
    let refused = write("loose.toml", &["--key", "wrong.txt"]);
    assert_eq!(refused.status.code(), Some(2), "{}", said(&refused));
    assert!(
        said(&refused).contains("refuses the key"),
        "{}",
        said(&refused)
    );
}

#[test]
fn a_line_that_is_no_text_is_reported_and_the_next_one_is_obeyed() {
    let mut child = hitch()
        .args(["ecu", "--host", "--seconds", "60"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut orders = child.stdin.take().unwrap();
    // Picked up after half a second.
    sleep(Duration::from_millis(700));
    orders
        .write_all(b"lever \xFF80\n\x80\r\nlock on\r\n")
        .unwrap();
    sleep(Duration::from_millis(300));
    orders.write_all(b"quit\n").unwrap();
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success());
    let reported = String::from_utf8(output.stderr).unwrap();
    assert!(
        reported.contains("`\u{FFFD}80` has to be a number"),
        "{reported}"
    );
    assert!(
        reported.contains("unknown command `\u{FFFD}`"),
        "{reported}"
    );
    let shown = String::from_utf8(output.stdout).unwrap();
    let last = shown.lines().last().unwrap();
    assert!(last.ends_with("transport-lock"), "{last}");
    let seconds: f64 = last.split_whitespace().next().unwrap().parse().unwrap();
    assert!(seconds < 10.0, "`quit` ends it: {last}");
}
