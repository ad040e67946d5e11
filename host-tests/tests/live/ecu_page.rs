//! The closed loop of `hitch serve --ecu`: the application of the ECU in real time, on the host and emulated.

use std::path::Path;
use std::process::Command;
use std::thread::sleep;
use std::time::{Duration, Instant};

use hitch_ecu_host::ecu::{IMAGE_VARIABLE, find_image};
use host_tests::loop_tab::LoopTab;
use host_tests::page_server::{Answer, PageServer};
use host_tests::program::{hitch, run};
use serde_json::{Value, json};
use tempfile::TempDir;

/// Time between two requests of the page.
const TURN: Duration = Duration::from_millis(50);

fn post(tab: &LoopTab<'_>, what: &str) -> Answer {
    tab.post(what, 50)
}

/// Asks as the page does for this long; the last answer, and the times of all samples.
fn follow(tab: &LoopTab<'_>, time: Duration) -> (Value, Vec<f64>) {
    let (begun, mut times) = (Instant::now(), Vec::new());
    loop {
        let answer = post(tab, "step");
        assert_eq!(answer.status, 200, "{}", answer.body);
        let view = answer.json();
        let loops = view["loops"].as_array().unwrap();
        assert_eq!(loops.len(), 1, "there is one ECU");
        let new = loops[0]["time_s"].as_array().unwrap();
        times.extend(new.iter().map(|time| time.as_f64().unwrap()));
        if begun.elapsed() >= time && !new.is_empty() {
            return (view, times);
        }
        sleep(TURN);
    }
}

/// Asks until the hitch is as wanted; the last answer.
fn until(tab: &LoopTab<'_>, wanted: impl Fn(&Value) -> bool) -> Value {
    let begun = Instant::now();
    loop {
        let (view, _) = follow(tab, TURN);
        if wanted(&view["loops"][0]) {
            return view["loops"][0].clone();
        }
        assert!(begun.elapsed() < Duration::from_secs(30), "{view}");
    }
}

fn last(hitch: &Value, signal: &str) -> f64 {
    let values = hitch[signal].as_array().unwrap();
    values.last().unwrap().as_f64().unwrap()
}

/// Lever, load, button and a broken sensor act on the ECU, whose time is real time.
fn the_ecu_follows_the_page(server: &PageServer) {
    let mut tab = LoopTab::new(server);
    let described = post(&tab, "describe");
    assert_eq!(described.json()["source"], "ecu", "{}", described.body);
    assert_eq!(
        post(&tab, "step").status,
        409,
        "a description starts nothing"
    );
    assert_eq!(post(&tab, "open").status, 200);
    until(&tab, |hitch| hitch["state"] == "holding");

    let begun = Instant::now();
    let (view, times) = follow(&tab, Duration::from_secs(2));
    let real_s = begun.elapsed().as_secs_f64();
    let ecu_s = times.last().unwrap() - times[0];
    println!(
        "{ecu_s:.2} s of the ECU in {real_s:.2} s, behind: {}",
        view["behind"]
    );
    assert!(ecu_s < real_s + 0.2, "{ecu_s} s in {real_s} s");
    assert!(
        view["behind"] == true || (ecu_s - real_s).abs() < 0.3,
        "{ecu_s} s in {real_s} s"
    );
    assert!(
        times
            .windows(2)
            .all(|pair| (pair[1] - pair[0] - 0.01).abs() < 1e-9)
    );

    tab.orders["lever_deg"] = json!(110.0);
    let arrived = |hitch: &Value| {
        hitch["state"] == "holding" && (last(hitch, "angle_deg") - 110.0).abs() < 0.5
    };
    let light_bar = last(&until(&tab, arrived), "cylinder_bar");
    tab.orders["load_kg"] = json!(350.0);
    // 200 kg at this angle are 10 to 30 bar.
    until(&tab, |hitch| last(hitch, "cylinder_bar") > light_bar + 10.0);

    tab.orders["button"] = json!("lower");
    until(&tab, |hitch| last(hitch, "angle_deg") < 105.0);
    tab.orders["button"] = Value::Null;
    until(&tab, |hitch| hitch["state"] == "locked");

    tab.orders["fault"] = json!({ "sensor": "angle", "kind": "open" });
    let broken = until(&tab, |hitch| hitch["state"] == "fault");
    assert!(broken["fault_text"].is_string(), "{broken}");
    tab.orders["fault"] = Value::Null;
    until(&tab, |hitch| hitch["state"] == "locked");
}

// REQ-MODE-02
#[test]
fn the_application_on_the_host_follows_the_page() {
    let dir = TempDir::new().unwrap();
    let server = PageServer::start(dir.path(), &["--ecu", "--host"]);
    the_ecu_follows_the_page(&server);
}

#[test]
fn one_tab_at_a_time_has_the_ecu() {
    let dir = TempDir::new().unwrap();
    let server = PageServer::start(dir.path(), &["--ecu", "--host"]);
    let (one, other) = (LoopTab::new(&server), LoopTab::new(&server));
    assert_eq!(post(&one, "open").status, 200);
    let refused = post(&other, "open");
    assert_eq!(refused.status, 409);
    assert!(
        refused.body.contains("in use by another tab"),
        "{}",
        refused.body
    );
    assert_eq!(post(&other, "describe").status, 200);
    let _ = follow(&one, TURN);
    // A new start by the same tab replaces its own.
    assert_eq!(post(&one, "open").status, 200);
    assert_eq!(post(&one, "close").status, 200);
    assert_eq!(post(&one, "step").status, 409);
    assert_eq!(post(&other, "open").status, 200);
    // A tab that has been closed is silent.
    sleep(Duration::from_millis(5_500));
    assert_eq!(post(&one, "open").status, 200);
    let gone = post(&other, "step");
    assert_eq!(gone.status, 410, "{}", gone.body);
    assert!(gone.body.contains("start it again"), "{}", gone.body);
}

// REQ-INPUT-01
#[test]
fn a_missing_image_or_emulator_is_said_as_by_hitch_ecu() {
    let dir = TempDir::new().unwrap();
    let without_emulator = |command: &str, more: &[&str]| {
        let mut program = hitch();
        program.env("PATH", "").current_dir(dir.path());
        let output = program.arg(command).args(more).output().unwrap();
        (
            output.status.code(),
            String::from_utf8(output.stderr).unwrap(),
        )
    };
    let page = without_emulator("serve", &["--ecu", "--no-browser"]);
    assert_eq!(page, without_emulator("ecu", &[]));
    assert_eq!(page.0, Some(2));
    assert!(page.1.contains("qemu-system-arm is missing"), "{}", page.1);
    let alone = run(dir.path(), &["serve", "--no-browser", "--host"]);
    assert_eq!(alone.status.code(), Some(2));
}

/// Process ids of the children of a process, over all its threads.
#[cfg(target_os = "linux")]
fn children(process: u32) -> Vec<String> {
    let threads = std::fs::read_dir(format!("/proc/{process}/task")).unwrap();
    let lists = threads
        .filter_map(|thread| std::fs::read_to_string(thread.ok()?.path().join("children")).ok());
    let all: String = lists.collect();
    all.split_whitespace().map(str::to_owned).collect()
}

#[cfg(target_os = "linux")]
#[test]
#[ignore = "needs the ARM image: run by `cargo xtask test`"]
fn the_emulated_ecu_follows_the_page_and_ends_with_it() {
    let dir = TempDir::new().unwrap();
    let image = find_image(None).unwrap();
    let folders = dir.path().join("temporary");
    std::fs::create_dir(&folders).unwrap();
    let variables: [(&str, &Path); 2] = [(IMAGE_VARIABLE, &image), ("TMPDIR", &folders)];
    let mut server = PageServer::start_with(dir.path(), &["--ecu"], &variables);
    the_ecu_follows_the_page(&server);
    assert_eq!(children(server.process()).len(), 1);
    let tab = LoopTab::new(&server);
    assert_eq!(post(&tab, "open").status, 409);
    // The first tab is silent; its emulator ends.
    sleep(Duration::from_millis(5_500));
    assert_eq!(children(server.process()).len(), 0);
    assert_eq!(post(&tab, "open").status, 200);
    let _ = follow(&tab, Duration::from_millis(500));
    let emulators = children(server.process());
    assert_eq!(emulators.len(), 1);
    let sent = Command::new("kill")
        .args(["-INT", &server.process().to_string()])
        .status();
    assert!(sent.unwrap().success());
    assert_eq!(server.wait(), Some(0));
    assert!(!Path::new("/proc").join(&emulators[0]).exists());
    assert_eq!(std::fs::read_dir(&folders).unwrap().count(), 0);
}
