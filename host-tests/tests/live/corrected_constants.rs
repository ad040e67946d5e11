//! Constants that an explanation corrects, in the page of `hitch serve`, without a browser.

use host_tests::page_server::PageServer;
use serde_json::{Value, json};
use tempfile::TempDir;
use truth_rigs::hidden_effects::wrong_base::declared;
use truth_rigs::second_rig::test_stand::Family;

#[test]
fn an_accepted_explanation_contains_the_corrected_constants() {
    let dir = TempDir::new().unwrap();
    let file = dir.path().join("data-sheet.toml");
    let model = declared(Family::Steady, 805);
    std::fs::write(&file, hitch_model_file::to_toml(&model)).unwrap();
    let campaign = format!("{}/campaigns/clean-steady", env!("CARGO_MANIFEST_DIR"));
    let server = PageServer::start(
        dir.path(),
        &[
            &campaign,
            "--model",
            file.to_str().expect("a name in UTF-8"),
        ],
    );
    let session = server.begin();
    let run = |task: Value| {
        assert_eq!(server.post("api/start", &task).status, 200, "{task}");
        server.settled(&session)
    };
    let explained = run(json!({ "session": session, "task": "explain" }));
    let found = &explained["explained"];
    let sentence = found["constants"]["sentence"].as_str();
    let sentence = sentence.unwrap_or_else(|| panic!("no constants: {found}"));
    assert!(
        sentence.starts_with("The declared constants are off."),
        "{sentence}"
    );
    assert_eq!(found["verdict"], "explained", "{found}");
    let steps: Vec<usize> = (0..found["steps"].as_array().unwrap().len()).collect();
    let taken = run(json!({ "session": session, "task": "adopt", "steps": steps }));
    assert_eq!(taken["steps"][1]["title"], "Fitted the constants");
    assert!(taken["error"].as_f64().unwrap() < 1.1, "{}", taken["error"]);

    // The saved model has the corrected margin.
    let saved = server.get(&format!("api/model?session={session}")).body;
    std::fs::write(&file, saved).unwrap();
    let saved = hitch_model_file::read(&file).expect("a model file");
    let margin_bar = |model: &hitch_plant::Model| model.constants().compensator.margin_pa / 1e5;
    println!("{} -> {}", margin_bar(&model), margin_bar(&saved));
    assert!((margin_bar(&saved) - 4.0).abs() < 0.1);
    assert!((margin_bar(&model) - 4.0).abs() > 0.1);
}
