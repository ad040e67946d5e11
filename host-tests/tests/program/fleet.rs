//! Many campaigns in one call: a line of JSON for each, also for one that fails.

use std::fs;
use std::path::Path;

use host_tests::program::run;
use serde_json::{Value, json};
use tempfile::TempDir;

use crate::json_schema::faults;
use crate::small_campaign::campaign;

/// Three copies of a campaign; the log of `b` is cut short.
fn fleet() -> TempDir {
    let dir = TempDir::new().unwrap();
    for name in ["a", "b", "c"] {
        copy(campaign().path(), &dir.path().join(name));
    }
    let log = dir.path().join("b/lower_2.2A_150kg.csv");
    fs::write(&log, "time_s\n0.0\n").unwrap();
    dir
}

fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let path = entry.unwrap().path();
        fs::copy(&path, to.join(path.file_name().unwrap())).unwrap();
    }
}

/// Exit code, standard output and messages of a call.
fn call(folder: &Path, arguments: &str) -> (Option<i32>, String, String) {
    let output = run(folder, &arguments.split(' ').collect::<Vec<_>>());
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    (
        output.status.code(),
        text(output.stdout),
        text(output.stderr),
    )
}

/// The lines in the order of their campaigns, each valid against the schema of the command.
fn lines(command: &str, text: &str) -> Vec<Value> {
    assert!(text.ends_with('\n'));
    let (_, schema, _) = call(Path::new("."), &format!("schema {command} --jsonl"));
    let schema = serde_json::from_str(&schema).unwrap();
    let mut lines: Vec<Value> = Vec::new();
    for line in text.lines() {
        assert!(line.starts_with("{\"format\":1,\"campaign\":\""), "{line}");
        lines.push(serde_json::from_str(line).unwrap());
    }
    let faults = faults(&schema, &lines).unwrap_or_default();
    assert!(faults.iter().all(Vec::is_empty), "{faults:?}");
    lines.sort_by_key(|line| line["campaign"].to_string());
    lines
}

#[test]
fn a_broken_campaign_does_not_stop_the_others() {
    let dir = fleet();
    let folder = dir.path();
    let (code, said, fault) = call(folder, "compare a b/ c --jsonl out.jsonl");
    assert_eq!(code, Some(1), "{fault}");
    assert!(said.starts_with("3 campaigns in out.jsonl"), "{said}");
    assert!(
        fault.ends_with(
            "hitch: 1 of 3 campaigns failed; their lines in out.jsonl have the reasons\n"
        )
    );
    let text = fs::read_to_string(folder.join("out.jsonl")).unwrap();
    let found = lines("compare", &text);
    let names: Vec<&Value> = found.iter().map(|line| &line["campaign"]).collect();
    assert_eq!(names, ["a", "b", "c"]);
    assert!(
        found[1]["error"]
            .as_str()
            .unwrap()
            .contains("lower_2.2A_150kg.csv")
    );
    // The line of a campaign is its document.
    let (_, document, _) = call(folder, "compare a --json -");
    let mut document: Value = serde_json::from_str(&document).unwrap();
    document["campaign"] = json!("a");
    assert_eq!(found[0], document);

    let (code, _, fault) = call(folder, "compare a --jsonl out.jsonl");
    assert_eq!(code, Some(2));
    assert!(
        fault.contains("out.jsonl: exists; continue it with --resume"),
        "{fault}"
    );
}

#[test]
fn a_call_resumes_after_the_lines_that_are_there() {
    let dir = fleet();
    let folder = dir.path();
    let out = folder.join("out.jsonl");
    call(folder, "compare a b --jobs 1 --jsonl out.jsonl");
    let before = fs::read_to_string(&out).unwrap();
    let kept = before.lines().next().unwrap();
    assert!(
        kept.contains("\"campaign\":\"a\""),
        "one job keeps the order"
    );
    // Interrupted in the line of b, which is then mended.
    fs::write(&out, format!("{kept}\n{{\"format\":1,\"camp")).unwrap();
    fs::remove_dir_all(folder.join("b")).unwrap();
    copy(&folder.join("a"), &folder.join("b"));
    let (code, said, fault) = call(folder, "compare a b c --jsonl out.jsonl --resume");
    assert_eq!(code, Some(0), "{fault}");
    assert_eq!(
        said,
        "3 campaigns in out.jsonl, 1 of them from earlier calls; 0 failed\n"
    );
    let after = fs::read_to_string(&out).unwrap();
    assert!(after.starts_with(&format!("{kept}\n")));
    assert_eq!(lines("compare", &after).len(), 3);
}

#[test]
fn explanations_and_changes_of_a_fleet() {
    let dir = fleet();
    let folder = dir.path();
    let (code, said, _) = call(folder, "explain a b c --jsonl - --jobs 2");
    assert_eq!(code, Some(1));
    let found = lines("explain", &said);
    for line in [&found[0], &found[2]] {
        assert_eq!(line["steps"][0]["effect"], "lower-threshold-shift");
    }
    assert!(found[1]["error"].is_string());

    let (code, said, _) = call(folder, "changes a b c --jsonl -");
    assert_eq!(code, Some(1));
    let found = lines("changes", &said);
    assert!(found[0]["campaign"] == "b" && found[0]["error"].is_string());
    assert!(found[1]["campaign"] == "c" && found[1]["new"]["steps"] == json!([]));
}

#[test]
fn options_for_one_campaign_are_refused_with_many() {
    let dir = fleet();
    for (arguments, reason) in [
        ("explain a c", "2 campaigns need --jsonl OUT"),
        (
            "explain a c --jsonl x --out m.toml",
            "--out is for one campaign",
        ),
        (
            "compare a c --jsonl x --json -",
            "--json is for one campaign",
        ),
        ("compare a --resume", "--jsonl"),
        ("compare a --jsonl - --resume", "no earlier lines"),
        (
            "compare a --jsonl a/campaign.toml",
            "is an input of this command",
        ),
        ("compare a --jsonl no/x", "cannot be written"),
        ("compare a --jsonl x --jobs 0", "--jobs"),
    ] {
        let (code, _, fault) = call(dir.path(), arguments);
        assert_eq!(code, Some(2), "{arguments}: {fault}");
        assert!(
            fault.contains(reason) && fault.lines().count() == 1,
            "{arguments}: {fault}"
        );
    }
    assert!(!dir.path().join("x").exists());
}

#[test]
fn a_summary_has_every_machine_and_names_a_foreign_line() {
    let dir = fleet();
    let folder = dir.path();
    call(folder, "explain a b c --budget 5 --jsonl out.jsonl");
    let (code, said, fault) = call(folder, "summary out.jsonl --json s.json --report s.html");
    assert_eq!(code, Some(0), "{fault}");
    assert!(
        said.starts_with("2 machines: ") && said.contains("1 without a result"),
        "{said}"
    );
    let summary: Value =
        serde_json::from_str(&fs::read_to_string(folder.join("s.json")).unwrap()).unwrap();
    let [first, second] = summary["machines"].as_array().unwrap().as_slice() else {
        panic!("two machines: {summary}");
    };
    assert_eq!(
        first["effects"], second["effects"],
        "the campaigns are copies"
    );
    for effect in summary["effects"].as_array().unwrap() {
        assert_eq!(
            (&effect["machines"], &effect["differ"]),
            (&json!(2), &json!(0)),
            "{effect}"
        );
    }
    let report = fs::read_to_string(folder.join("s.html")).unwrap();
    assert!(
        report.contains("<th scope=\"row\">a</th>") && report.contains("<th scope=\"row\">c</th>")
    );
    call(folder, "compare a c --jsonl compared.jsonl");
    let (code, _, fault) = call(folder, "summary out.jsonl compared.jsonl");
    assert_eq!(code, Some(2));
    assert!(fault.contains("compared.jsonl:1: "), "{fault}");
}
