//! Building the images for ARM.

use std::fs;
use std::path::PathBuf;

use anyhow::{Context, Result};

use crate::budget::{self, Entry};
use crate::toolchain::{TARGET, Way};
use crate::{process, programming, size};

/// The profile that images are built with: optimised, and arithmetic that overflows is caught.
const PROFILE: &str = "firmware";

/// Parts that there is a board for, by the features that choose them.
pub const PARTS: [&str; 2] = ["stm32f405", "stm32g474"];

/// Builds the control layer as the ECU takes it, proves that it can't panic, builds the images for the boards and the one
/// for the emulator, whose path is returned.
pub fn build_all(way: Way) -> Result<PathBuf> {
    let folder = folder(way);
    build(way, &["--lib"])?;
    build(way, &["--bin", "panic_proof", "--features", "emulated"]).context(
        "if `the_controller_can_panic` is undefined above, a step of the controller or a millisecond of the application can panic",
    )?;
    println!(
        "controller and application can't panic; with their start-up code they take {}",
        size::of(&folder.join("panic_proof"))?
    );
    budget::check(&build_boards(way)?)?;
    let image = build_emulated(way)?;
    println!("the emulated image takes {}", size::of(&image)?);
    Ok(image)
}

/// Builds an image for each part, as ELF, as plain bytes and as Intel HEX; what they take.
pub fn build_boards(way: Way) -> Result<Vec<Entry>> {
    let folder = folder(way);
    let mut entries = Vec::new();
    for part in PARTS {
        build(way, &["--bin", "ecu", "--features", part])?;
        // All parts build into the same place; each image is kept under its own name.
        let name = format!("ecu-{part}");
        let image = folder.join(&name);
        fs::copy(folder.join("ecu"), &image)
            .with_context(|| format!("can't write {}", image.display()))?;
        programming::write(&image)?;
        let size = size::of(&image)?;
        println!("{} takes {size}", image.display());
        entries.push(Entry::new(name, size));
    }
    Ok(entries)
}

/// Builds the image for the emulator; its path.
pub fn build_emulated(way: Way) -> Result<PathBuf> {
    build(way, &["--bin", "emulated", "--features", "emulated"])?;
    Ok(folder(way).join("emulated"))
}

fn folder(way: Way) -> PathBuf {
    way.target_dir().join(TARGET).join(PROFILE)
}

fn build(way: Way, what: &[&str]) -> Result<()> {
    let mut command = way.cargo("build")?;
    process::run(
        command
            .args(["--package", "hitch-firmware", "--profile", PROFILE])
            .args(what),
    )
}
