//! `hitch serve` without a browser: access control, and sessions of the tabs.
use std::fs;
use std::process::Command;

use host_tests::page_server::PageServer;
use host_tests::refusal;
use serde_json::{Value, json};
use tempfile::TempDir;

fn status(server: &PageServer, path: &str, headers: &[(&str, &str)]) -> u16 {
    server.request(&format!("GET {path}"), headers, "").status
}

// REQ-INPUT-04
#[test]
fn only_the_page_itself_is_let_in() {
    let dir = TempDir::new().unwrap();
    let server = PageServer::start(dir.path(), &[]);
    let host = server.host.as_str();
    let page = server.path.as_str();
    assert_eq!(status(&server, page, &[("Host", host)]), 200);
    assert_eq!(status(&server, "/", &[("Host", host)]), 403);
    assert_eq!(status(&server, "/wrong/", &[("Host", host)]), 403);
    let api = format!("{page}api/state?session=x");
    assert_eq!(
        status(&server, &api.replace(page, "/wrong/"), &[("Host", host)]),
        403
    );
    assert_eq!(status(&server, page, &[("Host", "evil.example")]), 403);
    let foreign = [("Host", host), ("Origin", "http://evil.example")];
    assert_eq!(status(&server, &api, &foreign), 403);
    assert_eq!(
        status(&server, page, &[("Host", host), ("Origin", "null")]),
        403
    );
    let own = format!("http://{host}");
    assert_eq!(
        status(&server, page, &[("Host", host), ("Origin", &own)]),
        200
    );
    assert_eq!(server.get("nothing.js").status, 404);
    assert!(
        server
            .get("")
            .head
            .contains("content-security-policy: default-src 'self'")
    );
}

// REQ-INPUT-04
#[test]
fn requests_that_make_no_sense_are_refused() {
    let dir = TempDir::new().unwrap();
    let server = PageServer::start(dir.path(), &[]);
    let oversized = json!({ "session": "x".repeat(100_000), "at": 0 });
    assert_eq!(server.post("api/go", &oversized).status, 413);
    let session = server.begin();
    assert_eq!(server.get("api/state?session=unknown").status, 410);
    assert_eq!(
        server
            .get(&format!("api/run?session={session}&run=999"))
            .status,
        404
    );
    let post = |path: &str, mut body: Value| {
        body["session"] = json!(session);
        server.post(path, &body).status
    };
    assert_eq!(post("api/go", json!({ "at": 7 })), 409);
    assert_eq!(post("api/go", json!({ "at": -1 })), 422);
    assert_eq!(
        post("api/start", json!({ "task": "add", "effect": "magic" })),
        422
    );
    assert_eq!(
        post("api/start", json!({ "task": "remove", "effect": 0 })),
        409
    );
    assert_eq!(
        post("api/start", json!({ "task": "adopt", "steps": [0] })),
        409
    );
    assert_eq!(post("api/start", json!({ "task": "dance" })), 422);
    let trial = json!({ "run": 0, "effect": 0, "parameter": 0, "value": 1.0 });
    assert_eq!(post("api/preview", trial), 409);
}

#[test]
fn a_session_adds_undoes_and_saves_beside_another() {
    let dir = TempDir::new().unwrap();
    let server = PageServer::start(dir.path(), &[]);
    let [one, other] = [server.begin(), server.begin()];
    let before = server.settled(&one);
    let task = json!({ "session": one, "task": "add", "effect": "lower-threshold-shift" });
    assert_eq!(server.post("api/start", &task).status, 200);
    assert_eq!(server.post("api/start", &task).status, 409);
    let after = server.settled(&one);
    let error = |state: &Value| state["error"].as_f64().unwrap();
    assert!(
        error(&before) > 5.0 && error(&after) < 1.1,
        "{} {}",
        before["error"],
        after["error"]
    );
    assert_eq!(
        after["effects"][0]["effect"]["name"],
        "lower-threshold-shift"
    );
    assert_eq!(server.settled(&other), before);

    let shift = after["effects"][0]["parameters"][0]["value"]
        .as_f64()
        .unwrap();
    let runs = after["runs"].as_array().unwrap();
    let lowers = |run: &Value| run["file"].as_str().unwrap().contains("lower");
    let run = runs.iter().position(lowers).unwrap();
    let trial = |value: f64| {
        let body =
            json!({ "session": one, "run": run, "effect": 0, "parameter": 0, "value": value });
        server.post("api/preview", &body).json()["channels"].clone()
    };
    assert!(trial(shift) != trial(shift + 0.1), "nothing moved");
    let all = |value: f64| {
        let body = json!({ "session": one, "effect": 0, "parameter": 0, "value": value });
        server.post("api/preview/all", &body).json()
    };
    let (same, moved) = (all(shift), all(shift + 0.1));
    assert!((error(&same) - error(&after)).abs() < 1e-9 && error(&moved) > error(&same));
    for (index, run) in runs.iter().enumerate() {
        let [listed, tried] =
            [&run["error"], &same["runs"][index]].map(|one| one.as_f64().unwrap());
        assert!((listed - tried).abs() < 1e-9, "{run}: {tried}");
    }
    let (was, is) = (&same["runs"][run], &moved["runs"][run]);
    assert!(is.as_f64().unwrap() > was.as_f64().unwrap(), "{was} {is}");

    let saved = server.get(&format!("api/model?session={one}"));
    assert!(saved.head.contains("attachment; filename=\"model.toml\""));
    fs::write(dir.path().join("model.toml"), &saved.body).unwrap();
    let model = dir.path().join("model.toml");
    let again = PageServer::start(dir.path(), &["--model", model.to_str().unwrap()]);
    assert!((error(&again.settled(&again.begin())) - error(&after)).abs() < 0.05);

    let undo = json!({ "session": one, "at": 0 });
    assert_eq!(server.post("api/go", &undo).status, 200);
    let undone = server.settled(&one);
    assert_eq!(
        (&undone["error"], undone["steps"].as_array().unwrap().len()),
        (&before["error"], 2)
    );
    assert_eq!(
        server
            .post("api/go", &json!({ "session": one, "at": 1 }))
            .status,
        200
    );
    assert_eq!(server.settled(&one)["error"], after["error"]);
}

#[test]
fn a_term_of_ones_own_is_checked_added_and_saved() {
    let dir = TempDir::new().unwrap();
    let server = PageServer::start(dir.path(), &[]);
    let offered = server.get("api/formulas").json();
    assert!(offered["places"].to_string().contains("lower-current"));
    let session = server.begin();
    let term = |formula: &str| {
        json!({ "id": "shift", "place": "lower-current", "formula": formula, "parameters": [{
            "name": "c", "unit": "A", "null": 0.0, "start": -0.1, "low": -0.5, "high": 0.5 }] })
    };
    let check = |formula: &str| {
        let answer = server.post("api/check", &json!({ "term": term(formula) }));
        answer.json()["fault"].clone()
    };
    assert!(check("c").is_null());
    assert_eq!(check("c * oops")["column"], 5);
    let start = |formula: &str| {
        let task = json!({ "session": session, "task": "term", "term": term(formula) });
        server.post("api/start", &task).status
    };
    assert_eq!(start("c *"), 422);
    assert_eq!(start("c"), 200);
    let after = server.settled(&session);
    assert!(after["error"].as_f64().unwrap() < 1.2, "{}", after["error"]);
    assert_eq!(start("c"), 409);
    let saved = server.get(&format!("api/model?session={session}")).body;
    assert!(
        saved.contains("[[term]]") && saved.contains("[[effect]]"),
        "{saved}"
    );
    fs::write(dir.path().join("model.toml"), &saved).unwrap();
    let model = dir.path().join("model.toml");
    let again = PageServer::start(dir.path(), &["--model", model.to_str().unwrap()]);
    assert_eq!(
        again.settled(&again.begin())["effects"]
            .as_array()
            .unwrap()
            .len(),
        1
    );
}

#[test]
fn a_suggested_term_is_taken_over() {
    let dir = TempDir::new().unwrap();
    let campaign = concat!(env!("CARGO_MANIFEST_DIR"), "/campaigns/known-outside");
    let server = PageServer::start(dir.path(), &[campaign]);
    let session = server.begin();
    let start = |task: &str| {
        let body = json!({ "session": session, "task": task });
        server.post("api/start", &body).status
    };
    assert_eq!(start("suggested"), 409);
    assert_eq!(start("explain"), 200);
    let explained = server.settled(&session);
    let suggested = &explained["explained"]["suggested"];
    assert!(suggested["formula"].is_string(), "{suggested}");
    assert_eq!(start("suggested"), 200);
    let after = server.settled(&session);
    let error = |state: &Value| state["error"].as_f64().unwrap();
    assert!(error(&after) < error(&explained));
    let saved = server.get(&format!("api/model?session={session}")).body;
    assert!(saved.contains("[[term]]"), "{saved}");
}

#[test]
fn a_cancelled_explanation_keeps_the_best_so_far() {
    let dir = TempDir::new().unwrap();
    let server = PageServer::start(dir.path(), &[]);
    let session = server.begin();
    let explain = json!({ "session": session, "task": "explain" });
    assert_eq!(server.post("api/start", &explain).status, 200);
    let of = json!({ "session": session });
    assert_eq!(server.post("api/cancel", &of).status, 200);
    let ended = server.settled(&session);
    assert!(ended["explained"]["verdict"].is_string(), "{ended}");
    // Cancelled twice, it is given up.
    assert_eq!(server.post("api/start", &explain).status, 200);
    for _ in 0..2 {
        assert_eq!(server.post("api/cancel", &of).status, 200);
    }
    assert_eq!(server.post("api/start", &explain).status, 200);
    assert!(server.settled(&session)["explained"]["verdict"].is_string());
}

#[test]
fn a_cancelled_ranking_leaves_the_session_usable() {
    let dir = TempDir::new().unwrap();
    let server = PageServer::start(dir.path(), &[]);
    let session = server.begin();
    let rank = json!({ "session": session, "task": "rank" });
    assert_eq!(server.post("api/start", &rank).status, 200);
    assert_eq!(
        server
            .post("api/cancel", &json!({ "session": session }))
            .status,
        200
    );
    assert!(server.settled(&session)["ranking"].is_null());
    assert_eq!(server.post("api/start", &rank).status, 200);
    let ranked = server.settled(&session);
    let best = &ranked["ranking"]["candidates"][0];
    assert_eq!(best["effect"]["name"], "lower-threshold-shift");
    assert_eq!(best["in_words"], "nearly certain");

    let view = |path: &str, run: usize| {
        let query = format!("session={session}&run={run}&effect=lower-threshold-shift");
        server.get(&format!("api/{path}?{query}"))
    };
    let rms =
        |values: &[f64]| (values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64).sqrt();
    let runs = ranked["runs"].as_array().unwrap();
    let lowers = |run: &Value| run["file"].as_str().unwrap().contains("lower");
    let run = runs.iter().position(lowers).unwrap();
    let numbers = |values: &Value| -> Vec<f64> {
        values
            .as_array()
            .unwrap()
            .iter()
            .filter_map(Value::as_f64)
            .collect()
    };
    let before = view("run", run).json();
    let explained = view("signature", run).json();
    let residual = numbers(&before["channels"][2]["residual"]);
    let signature = numbers(&explained["channels"][2]["signature"]);
    let rest: Vec<f64> = residual
        .iter()
        .zip(&signature)
        .map(|(a, b)| a - b)
        .collect();
    assert!(
        rms(&rest) < 0.5 * rms(&residual),
        "{} {}",
        rms(&rest),
        rms(&residual)
    );
    assert_eq!(view("signature", 999).status, 404);
}

#[test]
fn a_broken_campaign_shows_where_and_is_read_again_when_mended() {
    let dir = refusal::folder();
    let sound = refusal::log();
    refusal::write(&dir, "c/lift.csv", sound.replacen("16.0", "oops", 1));
    let server = PageServer::start(dir.path(), &["c"]);
    let begin = || server.post("api/begin", &json!({}));
    let fault = begin().json()["fault"].clone();
    assert_eq!(
        (&fault["line"], &fault["column"]),
        (&json!(2), &json!(18)),
        "{fault}"
    );
    assert!(
        fault["file"].as_str().unwrap().ends_with("lift.csv"),
        "{fault}"
    );
    refusal::write(&dir, "c/lift.csv", sound);
    assert_eq!(begin().status, 200);
}

#[test]
#[cfg(unix)]
fn ctrl_c_stops_it_and_nothing_is_left() {
    let dir = TempDir::new().unwrap();
    let mut server = PageServer::start(dir.path(), &[]);
    let rank = json!({ "session": server.begin(), "task": "rank" });
    assert_eq!(server.post("api/start", &rank).status, 200);
    let process = server.process().to_string();
    let sent = Command::new("kill")
        .args(["-INT", &process])
        .status()
        .unwrap();
    assert!(sent.success());
    assert_eq!(server.wait(), Some(0));
    assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 0);
}
