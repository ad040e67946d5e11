//! The module of controller and plant, compiled to WebAssembly.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use arm_build::{process, workspace};

/// What the module is compiled for.
const TARGET: &str = "wasm32-unknown-unknown";
/// Cargo profile of the module.
const PROFILE: &str = "page";

/// Compiles the module; returns its bytes.
///
/// # Errors
/// If there is no compiler for it, or it does not compile.
pub fn build() -> Result<Vec<u8>> {
    toolchain()?;
    // Apart from the other builds, which would wait for this one.
    let folder = workspace::target().join("wasm");
    let mut command = process::command(workspace::cargo(), &["build", "--locked"]);
    command
        .args(["--package", "hitch-try-page", "--lib"])
        .args(["--profile", PROFILE, "--target", TARGET, "--target-dir"])
        .arg(&folder);
    process::run(&mut command)?;
    let module = folder
        .join(TARGET)
        .join(PROFILE)
        .join("hitch_try_page.wasm");
    fs::read(&module).with_context(|| format!("can't read {}", module.display()))
}

/// Finds the library of the target, or installs it by rustup.
fn toolchain() -> Result<()> {
    if is_there() {
        return Ok(());
    }
    process::run(&mut process::command("rustup", &["target", "add", TARGET])).with_context(
        || {
            format!(
                "no compiler for {TARGET}; install it by `rustup target add {TARGET}`, with a network and Rust from rustup, or \
                 by the package of your system for it (Debian: libstd-rust-dev-wasm32)"
            )
        },
    )
}

/// Whether the toolchain in use has the library of the target.
fn is_there() -> bool {
    let root = process::output(&mut process::command("rustc", &["--print", "sysroot"]));
    let library = |root: String| -> PathBuf { Path::new(&root).join("lib/rustlib").join(TARGET) };
    root.is_some_and(|root| library(root).is_dir())
}
