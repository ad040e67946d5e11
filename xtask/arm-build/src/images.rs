//! Builds of the images.

use std::path::PathBuf;

use anyhow::Result;

use crate::process;
use crate::toolchain::{TARGET, Way};

/// Cargo profile of the images: optimised, with overflow checks.
const PROFILE: &str = "firmware";

/// Builds the image for the emulator and returns its path.
///
/// # Errors
/// If cargo can't build it.
pub fn build_emulated(way: Way) -> Result<PathBuf> {
    build(way, &["--bin", "emulated", "--features", "emulated"])?;
    Ok(folder(way).join("emulated"))
}

/// Folder of the images.
#[must_use]
pub fn folder(way: Way) -> PathBuf {
    way.target_dir().join(TARGET).join(PROFILE)
}

/// Builds a part of the ECU's crate, selected by arguments of cargo.
///
/// # Errors
/// If cargo can't build it.
pub fn build(way: Way, what: &[&str]) -> Result<()> {
    let mut command = way.cargo("build")?;
    process::run(
        command
            .args(["--package", "hitch-ecu", "--profile", PROFILE])
            .args(what),
    )
}
