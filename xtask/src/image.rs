//! Building the images for ARM.

use std::path::PathBuf;

use anyhow::Result;

use crate::toolchain::{TARGET, Way};
use crate::{process, size};

/// The profile that images are built with: optimised, and arithmetic that overflows is caught.
const PROFILE: &str = "firmware";

/// Builds the control layer as the ECU takes it and the image for the emulator; the image's path.
pub fn build_all(way: Way) -> Result<PathBuf> {
    let build = |what: &[&str]| {
        let mut command = way.cargo("build")?;
        process::run(
            command
                .args(["--package", "hitch-firmware", "--profile", PROFILE])
                .args(what),
        )
    };
    build(&["--lib"])?;
    build(&["--bin", "emulated", "--features", "emulated"])?;
    let image = way.target_dir().join(TARGET).join(PROFILE).join("emulated");
    println!("emulated image: {}", size::of(&image)?);
    Ok(image)
}
