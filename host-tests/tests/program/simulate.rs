//! The plant alone: on one log, on several, and on the runs of a campaign.

use std::fs;

use host_tests::program::run;
use serde_json::Value;

use crate::small_campaign::campaign;

#[test]
fn simulate_writes_a_log_that_can_be_read_again() {
    let dir = campaign();
    let simulate = [
        "simulate",
        "--inputs",
        "lower_2.2A_150kg.csv",
        "--load",
        "150",
        "--out",
    ];
    assert!(
        run(dir.path(), &[&simulate[..], &["a.csv"]].concat())
            .status
            .success()
    );
    let again = [
        "simulate", "--inputs", "a.csv", "--load", "150", "--out", "b.csv",
    ];
    assert!(run(dir.path(), &again).status.success());
    let read = |name: &str| fs::read_to_string(dir.path().join(name)).unwrap();
    assert_eq!(
        read("a.csv"),
        read("b.csv"),
        "simulating a simulated log changes nothing"
    );
    let to_stdout = run(dir.path(), &[&simulate[..], &["-"]].concat());
    assert_eq!(String::from_utf8(to_stdout.stdout).unwrap(), read("a.csv"));
}

/// Without noise in the simulated signals, the model that has simulated a campaign has almost no error on it.
#[test]
fn simulate_makes_a_campaign_of_a_campaign() {
    let dir = campaign();
    let simulate = ["simulate", ".", "--out", "simulated"];
    assert!(run(dir.path(), &simulate).status.success());
    let compared = run(dir.path(), &["compare", "simulated", "--json", "-"]);
    let compared: Value = serde_json::from_slice(&compared.stdout).unwrap();
    let error = compared["error"].as_f64().unwrap();
    assert!(error < 0.5, "{error}");
    let runs = |folder: &str| {
        let manifest = fs::read_to_string(dir.path().join(folder).join("campaign.toml")).unwrap();
        manifest.matches("[[run]]").count()
    };
    assert_eq!(runs("simulated"), runs("."));
    let again = run(dir.path(), &simulate);
    assert_eq!(again.status.code(), Some(2), "a folder with files is kept");
}

#[test]
fn simulate_of_several_logs_gives_each_what_it_gives_it_alone() {
    let dir = campaign();
    let log = "lower_2.2A_150kg.csv";
    fs::copy(dir.path().join(log), dir.path().join("copy.csv")).unwrap();
    let both = [
        "simulate", "--inputs", log, "copy.csv", "--load", "150", "--out", "both",
    ];
    assert!(run(dir.path(), &both).status.success());
    let alone = [
        "simulate",
        "--inputs",
        log,
        "--load",
        "150",
        "--out",
        "alone.csv",
    ];
    assert!(run(dir.path(), &alone).status.success());
    let read = |name: &str| fs::read_to_string(dir.path().join(name)).unwrap();
    for name in [log, "copy.csv"] {
        assert_eq!(read(&format!("both/{name}")), read("alone.csv"), "{name}");
    }
    let without = ["simulate", "--out", "nothing.csv"];
    assert_eq!(run(dir.path(), &without).status.code(), Some(2));
}
