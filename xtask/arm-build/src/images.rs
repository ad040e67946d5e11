//! Builds of the images.

use std::fs;
use std::path::PathBuf;

use anyhow::{Context, Result};

use crate::process;
use crate::toolchain::{ARM, Way};

/// Boards, by the features that select them: the ECU's with either part, and one to try the image out.
pub const BOARDS: [&str; 3] = ["stm32f405", "stm32g474", "nucleo-g474re"];

/// Cargo profile of the images: optimised, with overflow checks.
const PROFILE: &str = "firmware";

/// Builds everything for ARM: the library for the ECU, the image for the emulator and those for the boards.
///
/// # Errors
/// If cargo can't build it.
pub fn build_all(way: Way) -> Result<()> {
    build(way, &["--lib"])?;
    build_emulated(way)?;
    for board in BOARDS {
        build(way, &["--bin", "ecu", "--features", board])?;
        // All boards have the same build path; each image is copied under its own name.
        let path = of_board(way, board);
        fs::copy(folder(way).join("ecu"), &path)
            .with_context(|| format!("can't write {}", path.display()))?;
    }
    Ok(())
}

/// Builds the image for the emulator and returns its path.
///
/// # Errors
/// If cargo can't build it.
pub fn build_emulated(way: Way) -> Result<PathBuf> {
    build(way, &["--bin", "emulated", "--features", "emulated"])?;
    Ok(emulated(way))
}

/// Path of the image for the emulator.
#[must_use]
pub fn emulated(way: Way) -> PathBuf {
    folder(way).join("emulated")
}

/// Path of the image for a board.
#[must_use]
pub fn of_board(way: Way, board: &str) -> PathBuf {
    folder(way).join(format!("ecu-{board}"))
}

/// Folder of the images.
#[must_use]
pub fn folder(way: Way) -> PathBuf {
    way.target_dir(ARM).join(ARM.name).join(PROFILE)
}

/// Builds a part of the ECU's crate, selected by arguments of cargo.
fn build(way: Way, what: &[&str]) -> Result<()> {
    let mut command = way.cargo(ARM, "build")?;
    process::run(
        command
            .args(["--package", "hitch-ecu", "--profile", PROFILE])
            .args(what),
    )
}
