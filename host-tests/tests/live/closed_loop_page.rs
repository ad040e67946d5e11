//! The closed loop of `hitch serve`, without a browser.
use std::fs;

use host_tests::loop_tab::LoopTab;
use host_tests::page_server::{Answer, PageServer};
use host_tests::program::run;
use serde_json::{Value, json};
use tempfile::TempDir;

fn open(tab: &LoopTab<'_>) -> Answer {
    tab.post("open", 0)
}

fn step(tab: &LoopTab<'_>, milliseconds: i64) -> Answer {
    tab.post("step", milliseconds)
}

/// The last answer of some seconds.
fn advance(tab: &LoopTab<'_>, seconds: u32) -> Value {
    let mut answer = Value::Null;
    for _ in 0..seconds {
        let step = step(tab, 1000);
        assert_eq!(step.status, 200, "{}", step.body);
        answer = step.json();
    }
    answer
}

/// The last value of a signal of a hitch: 0 with the first calibration, 1 with the rebuilt one.
fn last(answer: &Value, hitch: usize, signal: &str) -> f64 {
    let values = answer["loops"][hitch][signal].as_array().unwrap();
    values.last().unwrap().as_f64().unwrap()
}

/// The mean of a signal of a hitch over the samples of an answer.
fn mean(answer: &Value, hitch: usize, signal: &str) -> f64 {
    let values = answer["loops"][hitch][signal].as_array().unwrap();
    let sum: f64 = values.iter().map(|value| value.as_f64().unwrap()).sum();
    sum / values.len() as f64
}

// REQ-MODE-02
#[test]
fn the_lever_moves_both_hitches_and_tabs_are_independent() {
    let dir = TempDir::new().unwrap();
    let server = PageServer::start(dir.path(), &[]);
    let (mut one, other) = (LoopTab::new(&server), LoopTab::new(&server));
    let opened = open(&one).json();
    assert_eq!(opened["equal"], true);
    assert_eq!(opened["linkage"]["positions"].as_array().unwrap().len(), 65);
    assert_eq!(open(&other).status, 200);
    one.orders["lever_deg"] = json!(110.0);
    let moved = advance(&one, 6);
    for hitch in 0..2 {
        assert!(
            (last(&moved, hitch, "angle_deg") - 110.0).abs() < 0.5,
            "{moved}"
        );
        assert_eq!(moved["loops"][hitch]["state"], "holding");
        let figures = &moved["loops"][hitch]["move"];
        assert!(
            figures["error_deg"].as_f64().unwrap().abs() < 0.5,
            "{figures}"
        );
        assert!(
            figures["overshoot_deg"].as_f64().unwrap() < 0.5,
            "{figures}"
        );
    }
    assert_eq!(
        moved["loops"][0]["angle_deg"].as_array().unwrap().len(),
        100
    );
    let still = advance(&other, 1);
    assert!((last(&still, 1, "angle_deg") - 90.0).abs() < 0.1, "{still}");
    println!("simulated seconds per second: {}", moved["speed"]);
    assert!(moved["speed"].as_f64().unwrap() > 1.0, "{}", moved["speed"]);
}

#[test]
fn load_and_buttons_act_during_the_run() {
    let dir = TempDir::new().unwrap();
    let server = PageServer::start(dir.path(), &[]);
    let mut tab = LoopTab::new(&server);
    assert_eq!(open(&tab).status, 200);
    let light_bar = mean(&advance(&tab, 1), 1, "cylinder_bar");
    tab.orders["load_kg"] = json!(250.0);
    // The sudden load rings on its oil at 5 Hz; the mean over a second is the pressure at rest.
    let heavy_bar = mean(&advance(&tab, 3), 1, "cylinder_bar");
    // The transmission at 90 degrees is 4.3, the piston 45.4 cm2: 100 kg are 9.3 bar.
    assert!(
        (heavy_bar - light_bar - 9.3).abs() < 0.3,
        "{light_bar} {heavy_bar}"
    );
    tab.orders["button"] = json!("raise");
    let raised = advance(&tab, 2);
    assert!(last(&raised, 1, "angle_deg") > 100.0, "{raised}");
    tab.orders["button"] = Value::Null;
    assert_eq!(advance(&tab, 1)["loops"][1]["state"], "locked");
}

// REQ-SAFE-03
#[test]
fn a_broken_angle_sensor_is_a_fault_until_it_is_repaired() {
    let dir = TempDir::new().unwrap();
    let server = PageServer::start(dir.path(), &[]);
    let mut tab = LoopTab::new(&server);
    // A sensor that has jumped by an offset looks healthy again after half a second: the lock follows the fault.
    for (kind, milliseconds) in [
        (json!("open"), 1000),
        (json!("frozen"), 1000),
        (json!({ "offset": 20.0 }), 200),
    ] {
        tab.orders["lever_deg"] = json!(90.0);
        assert_eq!(open(&tab).status, 200);
        tab.orders["lever_deg"] = json!(120.0);
        assert_eq!(step(&tab, 100).status, 200);
        tab.orders["fault"] = json!({ "sensor": "angle", "kind": kind });
        let broken = step(&tab, milliseconds).json();
        for hitch in 0..2 {
            let hitch = &broken["loops"][hitch];
            assert_eq!(hitch["state"], "fault", "{kind}: {hitch}");
            assert!(hitch["fault_text"].is_string(), "{hitch}");
        }
        let at_deg = last(&broken, 1, "angle_deg");
        let later_deg = last(&advance(&tab, 1), 1, "angle_deg");
        assert!(
            (at_deg - later_deg).abs() < 0.1,
            "{kind}: {at_deg} {later_deg}"
        );
        tab.orders["fault"] = Value::Null;
        assert_eq!(advance(&tab, 1)["loops"][1]["state"], "locked");
    }
}

// REQ-MOTION-06
#[test]
fn the_rebuilt_calibration_lowers_better_and_is_saved_as_by_the_command() {
    let dir = TempDir::new().unwrap();
    let server = PageServer::start(dir.path(), &[]);
    let mut tab = LoopTab::new(&server);
    let task = json!({ "session": tab.session, "task": "add", "effect": "lower-threshold-shift" });
    assert_eq!(server.post("api/start", &task).status, 200);
    let _ = server.settled(&tab.session);
    let opened = open(&tab).json();
    assert_eq!(opened["equal"], false);
    let threshold = |map: usize| {
        opened["maps"][map]["lower"]["threshold_a"]
            .as_f64()
            .unwrap()
    };
    assert!(
        (threshold(1) - threshold(0)).abs() > 0.1,
        "{}",
        opened["maps"]
    );
    tab.orders["lever_deg"] = json!(80.0);
    let lowered = advance(&tab, 8);
    let arrived_s = |hitch: usize| {
        let arrived_s = lowered["loops"][hitch]["move"]["arrived_s"].as_f64();
        arrived_s.unwrap_or(f64::INFINITY)
    };
    assert!(
        arrived_s(1) < arrived_s(0),
        "{} {}",
        arrived_s(1),
        arrived_s(0)
    );

    let saved = server.get(&format!("api/calibration?session={}", tab.session));
    assert!(
        saved
            .head
            .contains("attachment; filename=\"calibration.toml\"")
    );
    let model = server.get(&format!("api/model?session={}", tab.session));
    fs::write(dir.path().join("model.toml"), model.body).unwrap();
    let made = run(
        dir.path(),
        &["calibrate", "model.toml", "--out", "calibration.toml"],
    );
    assert!(made.status.success());
    let by_command = fs::read_to_string(dir.path().join("calibration.toml")).unwrap();
    assert_eq!(saved.body, by_command);

    let undo = json!({ "session": tab.session, "at": 0 });
    assert_eq!(server.post("api/go", &undo).status, 200);
    assert_eq!(step(&tab, 100).status, 409);
    assert_eq!(open(&tab).json()["equal"], true);
    assert_eq!(step(&tab, 100).status, 200);
}

// REQ-INPUT-04
#[test]
fn steps_that_make_no_sense_are_refused_and_leave_the_loop_usable() {
    let dir = TempDir::new().unwrap();
    let server = PageServer::start(dir.path(), &[]);
    let mut tab = LoopTab::new(&server);
    assert_eq!(step(&tab, 100).status, 409);
    assert_eq!(open(&tab).status, 200);
    for milliseconds in [-1, 0, 1001, i64::MAX] {
        assert_eq!(step(&tab, milliseconds).status, 422, "{milliseconds}");
    }
    let good = tab.orders.clone();
    for (key, value) in [
        ("lever_deg", json!(1e9)),
        ("lever_deg", Value::Null),
        ("load_kg", json!(-1.0)),
        ("oil_temperature_c", json!(1000.0)),
        ("button", json!("sideways")),
        (
            "fault",
            json!({ "sensor": "angle", "kind": { "offset": 1e300 } }),
        ),
        ("fault", json!({ "sensor": "moon", "kind": "frozen" })),
    ] {
        tab.orders = good.clone();
        tab.orders[key] = value;
        assert_eq!(step(&tab, 100).status, 422, "{}", tab.orders);
        assert_eq!(open(&tab).status, 422, "{}", tab.orders);
    }
    tab.orders = good.clone();
    tab.orders["note"] = json!("x".repeat(100_000));
    assert_eq!(step(&tab, 100).status, 413);
    tab.orders = good;
    assert_eq!(step(&tab, 100).status, 200);
    let unknown = json!({ "session": "x", "orders": tab.orders, "milliseconds": 100 });
    assert_eq!(server.post("api/loop/step", &unknown).status, 410);
}
