//! Runs the program `hitch` as a user does.
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::OnceLock;

/// Environment variable that names the program. `cargo xtask test` sets it to the one that the test build contains:
/// another build has other features of the dependencies and takes minutes.
const PROGRAM_VARIABLE: &str = "HITCH_PROGRAM";

/// A command that runs `hitch`: the one that the environment names, or one that is built if it is not up to date.
///
/// # Panics
/// If it cannot be built: then no test of it can run.
pub fn hitch() -> Command {
    static PROGRAM: OnceLock<PathBuf> = OnceLock::new();
    let named = || std::env::var_os(PROGRAM_VARIABLE).map(PathBuf::from);
    Command::new(PROGRAM.get_or_init(|| named().unwrap_or_else(build)))
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
