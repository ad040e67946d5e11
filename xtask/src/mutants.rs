//! Mutation test of the safety envelope: every change to its code has to be noticed by its tests.

use anyhow::{Result, bail};

use crate::process;
use crate::workspace;

/// Runs cargo-mutants as `.cargo/mutants.toml` says.
pub fn run() -> Result<()> {
    let installed = process::output(&mut process::command(
        workspace::cargo(),
        &["mutants", "--version"],
    ));
    if installed.is_none() {
        bail!("cargo-mutants is missing: cargo install --locked cargo-mutants");
    }
    let mut command = process::command(
        workspace::cargo(),
        &["mutants", "--package", "hitch-firmware", "--output"],
    );
    process::run(command.arg(workspace::target().join("mutants")))
}
