//! Outputs that cannot be, or would destroy something: refused before the work.
use std::fs;

use host_tests::refusal::{folder, log, refused, write};

// REQ-INPUT-02
#[test]
fn outputs_that_would_destroy_something_are_refused() {
    let dir = folder();
    let inputs = log();
    let same = ["simulate", "--inputs", "log.csv", "--out", "./log.csv"];
    refused(
        dir.path(),
        &same,
        "is an input of this command and would be overwritten",
    );
    assert_eq!(
        fs::read_to_string(dir.path().join("log.csv")).unwrap(),
        inputs
    );
    let manifest = ["explain", "c", "--out", "c/campaign.toml"];
    refused(
        dir.path(),
        &manifest,
        "c/campaign.toml: is an input of this command",
    );
    let measured = ["compare", "c", "--report", "c/lift.csv"];
    refused(
        dir.path(),
        &measured,
        "c/lift.csv: is an input of this command",
    );
    for name in ["c/day.blf", "c/bench.mat", "c/bench.parquet", "c/bench.lvm"] {
        write(&dir, name, "a log that the manifest does not name yet");
        let report = ["compare", "c", "--report", name];
        refused(
            dir.path(),
            &report,
            &format!("{name}: is an input of this command"),
        );
    }
    write(&dir, "m.toml", "format = 1\nbase = \"nominal\"\n");
    let model = ["calibrate", "m.toml", "--out", "m.toml"];
    refused(dir.path(), &model, "m.toml: is an input of this command");
    let twice = ["explain", "c", "--out", "x", "--report", "x", "--json", "x"];
    refused(dir.path(), &twice, "x: is the target of two results");
    let both = ["explain", "c", "--out", "-", "--json", "-"];
    refused(dir.path(), &both, "-: is the target of two results");
}

#[test]
#[cfg(target_os = "linux")]
fn outputs_that_cannot_be_written_are_noticed_before_the_work() {
    let dir = folder();
    let cases: [&[&str]; 5] = [
        &["--report", "/proc/r.html"],
        &["tune", "--out", "/proc/c.toml"],
        &["explain", "c", "--json", "/proc/x.json"],
        &["ecu", "--host", "--flash", "/proc/flash"],
        &["ecu", "--host", "--flash", "nowhere/flash"],
    ];
    for arguments in cases {
        refused(dir.path(), arguments, "cannot be written");
    }
    refused(
        dir.path(),
        &["ecu", "--host", "--flash", "-"],
        "--flash -: the file is read at the next start",
    );
    refused(
        dir.path(),
        &["controller", "--out", "-"],
        "--out -: standard output has the answers",
    );
}
