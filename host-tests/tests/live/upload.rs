//! Files opened in the page of `hitch serve`, without a browser.
use std::fs;
use std::path::Path;
use std::process::Command;

use host_tests::german_log::{german_log, german_log_in_volts};
use host_tests::page_server::{Answer, PageServer};
use host_tests::program::hitch;
use host_tests::refusal;
use serde_json::{Value, json};
use tempfile::TempDir;

/// A tab with the files that it opens.
struct Tab<'s> {
    server: &'s PageServer,
    session: String,
    upload: String,
}

impl<'s> Tab<'s> {
    fn new(server: &'s PageServer) -> Self {
        let session = server.begin();
        let body = json!({ "session": session, "files": 1, "bytes": 1 });
        let upload = server.post("api/upload/begin", &body).json()["upload"].clone();
        let upload = upload.as_str().expect("an upload").to_owned();
        Self {
            server,
            session,
            upload,
        }
    }

    /// Sends a file; its name as in an address.
    fn send(&self, name: &str, text: &str) -> Answer {
        let (session, upload) = (&self.session, &self.upload);
        let query = format!("session={session}&upload={upload}&name={name}");
        self.server.send(&format!("api/upload/file?{query}"), text)
    }

    fn post(&self, path: &str, mut body: Value) -> Answer {
        (body["session"], body["upload"]) = (json!(self.session), json!(self.upload));
        self.server.post(&format!("api/upload/{path}"), &body)
    }

    fn survey(&self) -> Answer {
        self.post("survey", json!({}))
    }

    fn state(&self) -> Value {
        self.server.settled(&self.session)
    }
}

/// The assignment as proposed.
fn proposed(proposal: &Value) -> Value {
    let logs = proposal["logs"].as_array().unwrap().iter();
    let logs = logs.map(|log| json!({ "bench": "hitch", "load_kg": log["load_kg"] }));
    let groups = proposal["groups"].as_array().unwrap().iter();
    let groups = groups.map(|group| group["taken"].clone());
    json!({
        "name": proposal["name"],
        "groups": groups.collect::<Vec<_>>(),
        "logs": logs.collect::<Vec<_>>(),
    })
}

/// The source of a signal in the first group.
fn source<'a>(assignment: &'a mut Value, channel: &str) -> &'a mut Value {
    let mut sources = assignment["groups"][0].as_array_mut().unwrap().iter_mut();
    sources.find(|taken| taken["channel"] == channel).unwrap()
}

#[test]
fn a_german_log_is_proposed_edited_and_opened_beside_another_tab() {
    let dir = TempDir::new().unwrap();
    let server = PageServer::start(dir.path(), &[]);
    let (tab, other) = (Tab::new(&server), Tab::new(&server));
    let before = other.state();
    assert_eq!(
        tab.send("logs%2FMontag_150kg.csv", &german_log()).status,
        200
    );
    assert_eq!(other.send("log.csv", &refusal::log()).status, 200);
    let proposal = tab.survey().json();
    assert_eq!(proposal["name"], "Montag_150kg", "{proposal}");
    assert_eq!(proposal["logs"][0]["load_kg"], 150.0);
    let mut assignment = proposed(&proposal);
    let current = source(&mut assignment, "lower_current_a");
    assert_eq!(
        (&current["column"], &current["unit"]),
        (&json!("Ventil Senken Strom"), &json!("mA"))
    );
    assert_eq!(current["assumed"], false, "{current}");

    // The pressures exchanged, as a user may do by mistake: the residuals are those of the wrong sensors.
    let right = assignment.clone();
    source(&mut assignment, "pump_pressure_bar")["column"] = json!("Zylinderdruck");
    source(&mut assignment, "cylinder_pressure_bar")["column"] = json!("Pumpendruck");
    assert_eq!(tab.post("open", assignment).status, 200);
    let exchanged = tab.state();
    assert_eq!(exchanged["campaign"], "Montag_150kg");
    assert_eq!(
        tab.post("open", right.clone()).status,
        410,
        "the files are deleted"
    );

    let again = Tab::new(&server);
    assert_eq!(again.send("Montag_150kg.csv", &german_log()).status, 200);
    assert_eq!(again.survey().status, 200);
    assert_eq!(again.post("open", right).status, 200);
    let state = again.state();
    assert_eq!(state["runs"].as_array().unwrap().len(), 1);
    let error = |state: &Value| state["error"].as_f64().unwrap();
    assert!(
        error(&exchanged) > 2.0 * error(&state),
        "{} {}",
        exchanged["error"],
        state["error"]
    );
    assert_eq!(other.state(), before);
}

#[test]
fn a_voltage_is_opened_by_two_known_points_of_its_sensor() {
    let dir = TempDir::new().unwrap();
    let server = PageServer::start(dir.path(), &[]);
    let (plain, volts) = (Tab::new(&server), Tab::new(&server));
    assert_eq!(plain.send("m_150kg.csv", &german_log()).status, 200);
    let assignment = proposed(&plain.survey().json());
    assert_eq!(plain.post("open", assignment).status, 200);

    assert_eq!(
        volts.send("m_150kg.csv", &german_log_in_volts()).status,
        200
    );
    let proposal = volts.survey().json();
    let notes = proposal["groups"][0]["notes"].to_string();
    assert!(
        notes.contains("Zylinderdruck") && notes.contains("it is in V") && !notes.contains("--map"),
        "{notes}"
    );
    let signals = proposal["signals"].as_array().unwrap();
    let pressure = signals
        .iter()
        .find(|one| one["key"] == "cylinder_pressure_bar");
    let raw = &pressure.unwrap()["raw"];
    for unit in ["V", "mA", "counts"] {
        assert!(raw.as_array().unwrap().contains(&json!(unit)), "{raw}");
    }
    let mut assignment = proposed(&proposal);
    let sources = assignment["groups"][0].as_array_mut().unwrap();
    sources.push(
        json!({ "channel": "cylinder_pressure_bar", "column": "Zylinderdruck", "unit": "V" }),
    );
    let refused = volts.post("open", assignment.clone());
    assert_eq!(refused.status, 422);
    let fault = refused.json()["fault"].to_string();
    assert!(
        fault.contains("which is not a unit of cylinder pressure")
            && !fault.contains("[columns]")
            && !fault.contains(" = "),
        "{fault}"
    );
    source(&mut assignment, "cylinder_pressure_bar")["points"] = json!([[0.5, 0.0], [4.5, 250.0]]);
    assert_eq!(volts.post("open", assignment).status, 200);
    let error = |tab: &Tab| tab.state()["error"].as_f64().unwrap();
    let (expected, found) = (error(&plain), error(&volts));
    assert!((found / expected - 1.0).abs() < 1e-3, "{expected} {found}");
}

#[test]
fn the_page_proposes_what_the_command_does() {
    let dir = TempDir::new().unwrap();
    fs::write(dir.path().join("lift_150kg.csv"), german_log()).unwrap();
    let imported = hitch()
        .args(["import", "lift_150kg.csv", "--out", "c", "--yes"])
        .current_dir(dir.path())
        .output()
        .unwrap();
    assert!(imported.status.success(), "{imported:?}");
    let server = PageServer::start(dir.path(), &["c"]);
    let by_command = server.settled(&server.begin());
    let tab = Tab::new(&server);
    assert_eq!(tab.send("lift_150kg.csv", &german_log()).status, 200);
    let mut assignment = proposed(&tab.survey().json());
    assignment["name"] = json!("c");
    assert_eq!(tab.post("open", assignment).status, 200);
    let by_page = tab.state();
    assert_eq!(
        (&by_page["error"], &by_page["cells"]),
        (&by_command["error"], &by_command["cells"])
    );
}

#[test]
fn a_campaign_folder_is_opened_with_its_own_files_only() {
    let dir = TempDir::new().unwrap();
    let server = PageServer::start(dir.path(), &[]);
    let tab = Tab::new(&server);
    assert_eq!(tab.send("c%2Fcampaign.toml", refusal::MANIFEST).status, 200);
    let missing = tab.survey();
    assert_eq!(missing.status, 422);
    let fault = missing.json()["fault"].clone();
    assert_eq!(
        (&fault["file"], &fault["line"]),
        (&json!("campaign.toml"), &json!(6)),
        "{fault}"
    );
    assert_eq!(tab.send("c%2Flift.csv", &refusal::log()).status, 200);
    assert_eq!(tab.survey().json()["runs"], 1);
    assert_eq!(tab.post("open", json!({})).status, 200);
    assert_eq!(tab.state()["campaign"], "small");

    fs::write(dir.path().join("outside.csv"), refusal::log()).unwrap();
    let outside = dir.path().join("outside.csv");
    for file in [
        outside.to_str().unwrap(),
        "../outside.csv",
        "x/../../outside.csv",
        "..",
    ] {
        let tab = Tab::new(&server);
        let manifest = refusal::MANIFEST.replace("lift.csv", file);
        assert_eq!(tab.send("campaign.toml", &manifest).status, 200);
        let answer = tab.survey();
        assert_eq!(answer.status, 422);
        assert!(answer.body.contains("in another folder"), "{}", answer.body);
    }
}

// REQ-INPUT-04
#[test]
fn faults_are_shown_with_file_line_and_column() {
    let dir = TempDir::new().unwrap();
    let server = PageServer::start(dir.path(), &[]);
    let fault = |name: &str, text: &str| {
        let tab = Tab::new(&server);
        assert_eq!(tab.send(name, text).status, 200, "{name}");
        let mut answer = tab.survey();
        if answer.status == 200 {
            let mut assignment = proposed(&answer.json());
            assignment["logs"][0]["load_kg"] = json!(150.0);
            answer = tab.post("open", assignment);
        }
        assert_eq!(answer.status, 422, "{name}: {}", answer.body);
        answer.json()["fault"].clone()
    };
    let broken = fault("lift.csv", &refusal::log().replacen("16.0", "oops", 1));
    assert_eq!(
        (&broken["file"], &broken["line"], &broken["column"]),
        (&json!("lift.csv"), &json!(2), &json!(18)),
        "{broken}"
    );
    let german = fault("m.csv", &german_log().replacen("130,52", "13o,52", 1));
    assert_eq!(
        (&german["file"], &german["line"]),
        (&json!("m.csv"), &json!(2)),
        "{german}"
    );
    for (name, text) in [
        ("a.csv", "\0\0\0"),
        ("a.mf4", "no measurement"),
        ("a.dbc", "VERSION"),
        ("model.toml", "format = 1"),
        ("campaign.toml", "format = "),
        ("a.log", "(1.0) can0 123#00"),
    ] {
        let fault = fault(name, text);
        assert!(fault["what"].as_str().unwrap().len() > 5, "{name}: {fault}");
        assert!(
            !fault.to_string().contains("upload-"),
            "a temporary folder is named: {fault}"
        );
    }
}

// REQ-INPUT-04
#[test]
fn edits_that_make_no_sense_are_refused() {
    let dir = TempDir::new().unwrap();
    let server = PageServer::start(dir.path(), &[]);
    let tab = Tab::new(&server);
    assert_eq!(tab.post("open", json!({})).status, 409);
    assert_eq!(tab.send("log_150kg.csv", &german_log()).status, 200);
    let good = proposed(&tab.survey().json());
    let refused = |channel: &str, key: &str, value: Value| {
        let mut assignment = good.clone();
        source(&mut assignment, channel)[key] = value;
        let answer = tab.post("open", assignment);
        assert_eq!(answer.status, 422, "{channel} {key}: {}", answer.body);
    };
    refused("lift_current_a", "unit", json!("bar"));
    refused("lift_current_a", "column", json!("Mond"));
    refused("lift_current_a", "channel", json!("moon"));
    refused("lift_current_a", "channel", json!("lower_current_a"));
    refused("time_s", "channel", json!("oil_temperature_c"));
    let mut negative = good.clone();
    for load in [json!(-1.0), json!(1e9), Value::Null] {
        negative["logs"][0]["load_kg"] = load;
        assert_eq!(tab.post("open", negative.clone()).status, 422);
    }
    let mut fewer = good.clone();
    fewer["logs"] = json!([]);
    assert_eq!(tab.post("open", fewer).status, 422);
    assert_eq!(tab.state()["campaign"], "demonstration");
    assert_eq!(tab.post("open", good).status, 200);
}

// REQ-INPUT-04
#[test]
fn sizes_numbers_and_names_are_limited() {
    let dir = TempDir::new().unwrap();
    let server = PageServer::start(dir.path(), &[]);
    let tab = Tab::new(&server);
    for (files, bytes, status) in [(0, 1, 422), (257, 1, 413), (1, (256 << 20) + 1, 413)] {
        let body = json!({ "session": tab.session, "files": files, "bytes": bytes });
        assert_eq!(server.post("api/upload/begin", &body).status, status);
    }
    let (session, upload) = (&tab.session, &tab.upload);
    let line = format!(
        "POST {}api/upload/file?session={session}&upload={upload}&name=a.csv",
        server.path
    );
    let long = ((256 << 20) + 1).to_string();
    let headers = [("Host", server.host.as_str()), ("Content-Length", &long)];
    assert_eq!(server.request(&line, &headers, "").status, 413);
    for name in ["", "..", "%2F", "a%00b", "a%0Ab", &"x".repeat(300)] {
        assert_eq!(tab.send(name, "1").status, 422, "{name}");
    }
    assert_eq!(
        tab.send("..%2F..%2Fescaped.csv", "1").json()["file"],
        "escaped.csv"
    );
    assert!(!Path::new("../../escaped.csv").exists());
    assert_eq!(
        tab.send("%2Ftmp%2FESCAPED.csv", "1").status,
        422,
        "the name is taken"
    );
    for number in 1..256 {
        assert_eq!(tab.send(&format!("{number}.csv"), "1").status, 200);
    }
    assert_eq!(tab.send("more.csv", "1").status, 413);

    let foreign = Tab {
        session: server.begin(),
        upload: tab.upload.clone(),
        server: &server,
    };
    assert_eq!(foreign.send("b.csv", "1").status, 410);
    assert_eq!(foreign.survey().status, 410);
    let headers = [
        ("Host", server.host.as_str()),
        ("Origin", "http://evil.example"),
    ];
    assert_eq!(server.request(&line, &headers, "1").status, 403);
    let wrong = line.replace(&server.path, "/wrong/");
    assert_eq!(
        server
            .request(&wrong, &[("Host", &server.host)], "1")
            .status,
        403
    );
}

#[test]
#[cfg(unix)]
fn stopping_leaves_no_file() {
    for signal in ["-INT", "-TERM"] {
        let dir = TempDir::new().unwrap();
        let temporary = TempDir::new().unwrap();
        let mut server = PageServer::start_with(dir.path(), &[], &[("TMPDIR", temporary.path())]);
        let tab = Tab::new(&server);
        assert_eq!(tab.send("log.csv", &refusal::log()).status, 200);
        let there = || fs::read_dir(temporary.path()).unwrap().count();
        assert_eq!(there(), 1);
        let process = server.process().to_string();
        let sent = Command::new("kill")
            .args([signal, &process])
            .status()
            .unwrap();
        assert!(sent.success());
        assert_eq!(server.wait(), Some(0), "{signal}");
        assert_eq!(there(), 0, "{signal}");
    }
}
