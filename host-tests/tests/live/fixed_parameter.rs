//! Parameters that are fixed in the page of `hitch serve`, without a browser.

use host_tests::page_server::PageServer;
use serde_json::{Value, json};
use tempfile::TempDir;

/// Runs a task; the state after it.
fn done(server: &PageServer, session: &str, mut task: Value) -> Value {
    task["session"] = json!(session);
    let answer = server.post("api/start", &task);
    assert_eq!(answer.status, 200, "{task}: {}", answer.body);
    server.settled(session)
}

fn size(state: &Value, effect: usize) -> f64 {
    parameter(state, effect)["value"].as_f64().unwrap()
}

fn parameter(state: &Value, effect: usize) -> &Value {
    &state["effects"][effect]["parameters"][0]
}

fn error(state: &Value) -> f64 {
    state["error"].as_f64().unwrap()
}

#[test]
fn a_fixed_parameter_keeps_its_value_until_it_is_freed() {
    let dir = TempDir::new().unwrap();
    let server = PageServer::start(dir.path(), &[]);
    let session = server.begin();
    let run = |task: Value| done(&server, &session, task);
    let added = run(json!({ "task": "add", "effect": "lower-threshold-shift" }));
    let fitted = size(&added, 0);
    let wanted = 0.8 * fitted;
    run(json!({ "task": "set", "effect": 0, "parameter": 0, "value": wanted }));
    let fixed = run(json!({ "task": "fix", "effect": 0, "parameter": 0, "fixed": true }));
    assert_eq!(parameter(&fixed, 0)["fixed"], true);
    let (at, title) = (&fixed["at"], &fixed["steps"][3]["title"]);
    assert_eq!(
        (at, title.as_str().unwrap()),
        (&json!(3), "Fixed shift of lower-threshold-shift")
    );

    // In fits with and without another effect, to the last digit.
    let fit = run(json!({ "task": "fit" }));
    assert_eq!(size(&fit, 0).to_bits(), wanted.to_bits());
    let both = run(json!({ "task": "add", "effect": "lift-threshold-shift" }));
    assert_eq!(size(&both, 0).to_bits(), wanted.to_bits());
    assert_eq!(parameter(&both, 1)["fixed"], false);
    assert!(size(&both, 1) != 0.0, "the other effect is fitted");

    // The saved model has the fixed value, and its history the fixing.
    let saved = server.get(&format!("api/model?session={session}")).body;
    assert!(
        saved.contains("# 3. Fixed shift of lower-threshold-shift"),
        "{saved}"
    );

    // Free, the error is not larger, and the size is that of before.
    run(json!({ "task": "fix", "effect": 0, "parameter": 0, "fixed": false }));
    let free = run(json!({ "task": "fit" }));
    assert!(
        error(&free) <= error(&both),
        "{} {}",
        error(&free),
        error(&both)
    );
    assert!(
        (size(&free, 0) / fitted - 1.0).abs() < 0.02,
        "{} {fitted}",
        size(&free, 0)
    );

    // Undone to the step of before, it is fixed again; before that, free.
    for (at, is_fixed) in [(5, true), (3, true), (2, false)] {
        let go = json!({ "session": session, "at": at });
        assert_eq!(server.post("api/go", &go).status, 200);
        assert_eq!(
            parameter(&server.settled(&session), 0)["fixed"],
            is_fixed,
            "step {at}"
        );
    }
    let wrong =
        json!({ "session": session, "task": "fix", "effect": 0, "parameter": 9, "fixed": true });
    assert_eq!(server.post("api/start", &wrong).status, 409);
}
