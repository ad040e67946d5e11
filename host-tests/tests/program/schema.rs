//! The documents of `--json` against the schemas of `hitch schema`.

use std::path::Path;

use host_tests::program::run;
use serde_json::{Value, json};

use crate::json_schema::faults;
use crate::small_campaign::campaign;

/// The schema of a command's document, as it is printed.
fn schema(command: &str) -> Value {
    let mut arguments = vec!["schema"];
    arguments.extend(command.split(' '));
    let output = run(Path::new("."), &arguments);
    assert!(output.status.success(), "{output:?}");
    serde_json::from_slice(&output.stdout).unwrap()
}

/// Forbids keys that a schema does not list: its descriptions are then complete.
fn close(schema: &mut Value) {
    match schema {
        Value::Object(object) => {
            if object.contains_key("properties") {
                object.insert("additionalProperties".to_owned(), json!(false));
            }
            object.values_mut().for_each(close);
        }
        Value::Array(values) => values.iter_mut().for_each(close),
        _ => {}
    }
}

/// Validates the document of a command against its schema, and against the closed schema.
fn assert_valid(folder: &Path, command: &str, more: &str) {
    assert_valid_with(folder, command, more, 0);
}

/// The same of a command that ends with this exit code.
fn assert_valid_with(folder: &Path, command: &str, more: &str, code: i32) {
    let arguments = format!("{command} {more} --json -");
    let output = run(folder, &arguments.split_whitespace().collect::<Vec<_>>());
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "{arguments}: {said}");
    assert!(
        output.stdout.starts_with(b"{\n  \"format\": 1,\n"),
        "{arguments}: the version is first"
    );
    let document: Value = serde_json::from_slice(&output.stdout).unwrap();
    let mut schema = schema(command);
    let mut wrong = document.clone();
    wrong["format"] = json!(2);
    let Some(found) = faults(&schema, &[document.clone(), wrong]) else {
        return;
    };
    assert!(found[0].is_empty(), "{arguments}: {:?}", found[0]);
    assert!(!found[1].is_empty(), "{command}: the version is fixed");
    close(&mut schema);
    let closed = faults(&schema, &[document]).expect("Python is there");
    assert!(closed[0].is_empty(), "{arguments}: {:?}", closed[0]);
}

#[test]
fn documents_on_a_campaign_follow_their_schemas() {
    let dir = campaign();
    let folder = dir.path();
    assert_valid(folder, "compare", ".");
    assert_valid(folder, "diagnose", ".");
    assert_valid(folder, "explain", ".");
    assert_valid(folder, "changes", ". .");
    assert_valid(folder, "model fit", ". --out fitted.toml");
}

#[test]
fn documents_of_the_closed_loop_follow_their_schemas() {
    let dir = tempfile::tempdir().unwrap();
    let folder = dir.path();
    assert_valid(folder, "loop", "--scenario quick --load 150");
    let variant = "--variant soft:position.approach_gain=30";
    assert_valid(
        folder,
        "loop",
        &format!("--scenario rate --load 150 {variant}"),
    );
    assert_valid(
        folder,
        "loop",
        &format!("--scenario quick --load 150 {variant}"),
    );
    // Too heavy to lift: times without a value.
    assert_valid_with(folder, "loop", "--scenario ends --load 2000", 2);
    assert_valid(
        folder,
        "tune",
        "--scenario quick --loads 150 --trials 10 --out tuned.toml --force",
    );
    assert_valid(
        folder,
        "tune",
        "--scenario rate --loads 150 --trials 10 --out tuned.toml --force",
    );
}

#[test]
fn the_document_of_the_effects_follows_its_schema() {
    assert_valid(Path::new("."), "effects", "");
    assert_valid(Path::new("."), "effects", "coulomb-friction");
}

#[test]
fn a_command_without_a_document_is_refused() {
    let list = run(Path::new("."), &["schema"]);
    let list = String::from_utf8(list.stdout).unwrap();
    assert!(
        list.contains("explain\n") && list.contains("model fit\n"),
        "{list}"
    );
    let refused = run(Path::new("."), &["schema", "import"]);
    let said = String::from_utf8(refused.stderr).unwrap();
    assert_eq!(refused.status.code(), Some(2));
    assert!(
        said.contains("\"import\"") && said.contains("explain"),
        "{said}"
    );
}
