//! Runs the program `hitch` as a user does.
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::OnceLock;

/// A command that runs `hitch`, built if it is not up to date.
///
/// # Panics
/// If it cannot be built: then no test of it can run.
pub fn hitch() -> Command {
    static PROGRAM: OnceLock<PathBuf> = OnceLock::new();
    Command::new(PROGRAM.get_or_init(build))
}

/// Runs `hitch` in a folder.
///
/// # Panics
/// If it cannot be started.
pub fn run(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = hitch();
    command.args(arguments).current_dir(folder);
    command.output().expect("hitch starts")
}

/// Builds the program with the profile of this test, into the folder that the test itself was built into.
fn build() -> PathBuf {
    let test = std::env::current_exe().expect("a test has a path");
    let folder = test
        .ancestors()
        .nth(2)
        .expect("tests are built into target/PROFILE/deps");
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args([
        "build",
        "--quiet",
        "--package",
        "hitch-workbench",
        "--bin",
        "hitch",
        "--target-dir",
    ]);
    cargo.arg(
        folder
            .parent()
            .expect("a profile's folder is in a target folder"),
    );
    if folder.ends_with("release") {
        cargo.arg("--release");
    }
    let built = cargo
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .status()
        .expect("cargo starts");
    assert!(built.success(), "hitch cannot be built");
    folder.join(format!("hitch{}", std::env::consts::EXE_SUFFIX))
}
