//! The module of controller and plant, compiled to WebAssembly.

use std::fs;

use anyhow::{Context, Result};
use arm_build::toolchain::WASM;
use arm_build::{process, setup};

/// Cargo profile of the module.
const PROFILE: &str = "page";

/// Compiles the module; returns its bytes.
///
/// # Errors
/// If there is no compiler for it, or it does not compile.
pub fn build() -> Result<Vec<u8>> {
    let way = setup::toolchain(None, WASM)?;
    let mut command = way.cargo(WASM, "build")?;
    command
        .args(["--package", "hitch-try-page", "--lib"])
        .args(["--profile", PROFILE]);
    process::run(&mut command)?;
    let folder = way.target_dir(WASM).join(WASM.name).join(PROFILE);
    let module = folder.join("hitch_try_page.wasm");
    fs::read(&module).with_context(|| format!("can't read {}", module.display()))
}
