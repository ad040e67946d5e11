//! The scripts of `docs` find the program and their packages, or say in one line what is missing.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use host_tests::program::hitch;

fn docs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs")
}

/// A copy of the example with its own plant, in the folder `docs` of a clone that is not built.
fn clone() -> tempfile::TempDir {
    let clone = tempfile::tempdir().unwrap();
    fs::create_dir(clone.path().join("docs")).unwrap();
    for file in ["own_plant.py", "hitch_program.py"] {
        fs::copy(docs().join(file), clone.path().join("docs").join(file)).unwrap();
    }
    clone
}

/// Python, found on `PATH` by this test, without a `PATH` of its own and without packages.
fn python() -> Command {
    let path = Command::new("python3")
        .args(["-c", "import sys; print(sys.executable)"])
        .output()
        .expect("the examples need python3");
    let mut python = Command::new(String::from_utf8(path.stdout).unwrap().trim());
    for variable in ["HITCH_PROGRAM", "CARGO_TARGET_DIR"] {
        python.env_remove(variable);
    }
    python
        .env("PATH", "")
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .arg("-S");
    python
}

fn assert_moves(output: &Output) {
    let said = String::from_utf8_lossy(&output.stdout);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}{errors}");
    assert_eq!(said.matches(" deg: at ").count(), 3, "{said}");
}

fn assert_one_line(output: &Output, expected: &str) {
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(!output.status.success());
    assert_eq!(errors.lines().count(), 1, "{errors}");
    assert!(errors.contains(expected), "{errors}");
}

#[test]
fn an_example_finds_the_program_by_variable_path_and_build() {
    let clone = clone();
    let example = clone.path().join("docs/own_plant.py");
    let program = fs::canonicalize(hitch().get_program()).unwrap();
    let named = python()
        .arg(&example)
        .env("HITCH_PROGRAM", &program)
        .output();
    assert_moves(&named.unwrap());
    let on_path = python()
        .arg(&example)
        .env("PATH", program.parent().unwrap())
        .output();
    assert_moves(&on_path.unwrap());
    let built = clone.path().join("target/debug");
    fs::create_dir_all(&built).unwrap();
    let name = format!("hitch{}", std::env::consts::EXE_SUFFIX);
    fs::copy(&program, built.join(name)).unwrap();
    assert_moves(&python().arg(&example).output().unwrap());
}

#[test]
fn a_missing_program_is_one_line() {
    let clone = clone();
    let example = clone.path().join("docs/own_plant.py");
    let missing = python().arg(&example).output().unwrap();
    assert_one_line(&missing, "cargo build --release");
    let given = python().arg(&example).arg("no/hitch").output().unwrap();
    assert_one_line(&given, "no/hitch: is not a program");
    let named = python()
        .arg(&example)
        .env("HITCH_PROGRAM", "nothing")
        .output();
    assert_one_line(&named.unwrap(), "nothing: is not a program");
}

#[test]
fn a_missing_package_is_one_line() {
    for (script, expected) in [
        ("tune_live.py", "pip install pyxcp"),
        ("fmu_loop.py", "pip install fmpy"),
    ] {
        let output = python().arg(docs().join(script)).output().unwrap();
        assert_one_line(&output, expected);
    }
}
