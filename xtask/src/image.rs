//! Building the images for ARM.

use std::path::PathBuf;

use anyhow::{Context, Result};

use crate::toolchain::{TARGET, Way};
use crate::{process, size};

/// The profile that images are built with: optimised, and arithmetic that overflows is caught.
const PROFILE: &str = "firmware";

/// Builds the control layer as the ECU takes it, proves that it can't panic, and builds the image for the emulator,
/// whose path is returned.
pub fn build_all(way: Way) -> Result<PathBuf> {
    let folder = way.target_dir().join(TARGET).join(PROFILE);
    build(way, &["--lib"])?;
    build(way, &["--bin", "panic_proof", "--features", "emulated"]).context(
        "if `the_controller_can_panic` is undefined above, a step of the controller can panic",
    )?;
    println!(
        "the controller can't panic; with its start-up code it takes {}",
        size::of(&folder.join("panic_proof"))?
    );
    build(way, &["--bin", "emulated", "--features", "emulated"])?;
    let image = folder.join("emulated");
    println!("the emulated image takes {}", size::of(&image)?);
    Ok(image)
}

fn build(way: Way, what: &[&str]) -> Result<()> {
    let mut command = way.cargo("build")?;
    process::run(
        command
            .args(["--package", "hitch-firmware", "--profile", PROFILE])
            .args(what),
    )
}
