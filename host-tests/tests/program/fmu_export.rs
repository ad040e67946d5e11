//! `hitch export-fmu` with arguments that are wrong, or without the shared library.

use std::fs;
use std::process::Command;

use host_tests::program::{hitch, run};

#[test]
fn a_wrong_export_is_one_line_and_leaves_no_file() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("bad.toml"), "format = 1\nnonsense = 2\n").unwrap();
    for (arguments, expected) in [
        (&["bad.toml", "--out", "x.fmu"][..], "bad.toml:"),
        (&["missing.toml", "--out", "x.fmu"], "no such model"),
        (&["dynamic", "--out", "-"], "--out -: "),
        (
            &["dynamic", "--out", "no/x.fmu"],
            "no/x.fmu: cannot be written",
        ),
        (&["dynamic"], "--out"),
        (
            &["dynamic", "--calibration", "bad.toml", "--out", "x.fmu"],
            "--controller",
        ),
        (
            &[
                "--controller",
                "--calibration",
                "bad.toml",
                "--out",
                "x.fmu",
            ],
            "bad.toml:",
        ),
        (&["bad.toml", "--out", "bad.toml"], "would be overwritten"),
    ] {
        let output = run(folder.path(), &[&["export-fmu"], arguments].concat());
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {said}");
        assert!(said.contains(expected), "{arguments:?}: {said}");
        assert_eq!(said.lines().count(), 1, "{said}");
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn a_missing_library_is_reported_with_the_searched_places() {
    let folder = tempfile::tempdir().unwrap();
    let alone = folder.path().join("hitch");
    fs::copy(hitch().get_program(), &alone).unwrap();
    let mut command = Command::new(&alone);
    let command = command.args(["export-fmu", "dynamic", "--out", "x.fmu"]);
    let output = command.current_dir(folder.path()).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(
        said.contains("hitch_fmu") && said.contains("cargo build"),
        "{said}"
    );
    assert!(!folder.path().join("x.fmu").exists());
}
