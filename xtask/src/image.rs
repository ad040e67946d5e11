//! Builds the images for ARM.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use arm_build::images::{build, build_emulated, folder};
use arm_build::toolchain::Way;
use image_stack::Bound;

use crate::budget::{self, Entry};
use crate::{programming, seal, size};

/// Supported parts, by the features that select them.
pub const PARTS: [&str; 2] = ["stm32f405", "stm32g474"];

/// The image for the emulator.
pub struct Emulated {
    /// Path.
    pub path: PathBuf,
    /// Maximum stack depth.
    pub stack: Bound,
}

/// Builds the library for the ECU, proves that it cannot panic, builds all images, and checks them against their
/// budgets.
pub fn build_all(way: Way) -> Result<Emulated> {
    let folder = folder(way);
    build(way, &["--lib"])?;
    build(way, &["--bin", "panic_proof", "--features", "emulated"]).context(
        "if `the_controller_can_panic` is undefined above, a step of the controller or a millisecond of the application can panic",
    )?;
    println!(
        "controller and application can't panic; with their start-up code they take {}",
        size::of(&folder.join("panic_proof"))?
    );
    let (images, emulated) = build_images(way)?;
    let entries: Vec<Entry> = images.iter().map(|image| image.entry.clone()).collect();
    budget::check(&entries)?;
    Ok(emulated)
}

/// Builds the images; returns their sizes.
pub fn sizes(way: Way) -> Result<Vec<Entry>> {
    let (images, _) = build_images(way)?;
    Ok(images.into_iter().map(|image| image.entry).collect())
}

/// Builds the images and prints their maximum stack depths with the calls.
pub fn show_stacks(way: Way) -> Result<()> {
    let (images, _) = build_images(way)?;
    for image in images {
        println!("\n{}\n{}", image.entry.name(), image.stack);
    }
    Ok(())
}

/// A built image.
struct Image {
    entry: Entry,
    stack: Bound,
}

impl Image {
    fn measured(name: String, path: &Path) -> Result<Self> {
        let (size, stack) = (size::of(path)?, image_stack::of(path)?);
        println!(
            "{} takes {size}, and at most {} B of stack",
            path.display(),
            stack.bytes()
        );
        let entry = Entry::new(name, size, stack.bytes());
        Ok(Self { entry, stack })
    }
}

/// Builds an image for each part, as ELF, as plain bytes and as Intel HEX, and the one for the emulator.
fn build_images(way: Way) -> Result<(Vec<Image>, Emulated)> {
    let folder = folder(way);
    let mut images = Vec::new();
    for part in PARTS {
        build(way, &["--bin", "ecu", "--features", part])?;
        // All parts have the same build path; each image is copied under its own name.
        let name = format!("ecu-{part}");
        let path = folder.join(&name);
        fs::copy(folder.join("ecu"), &path)
            .with_context(|| format!("can't write {}", path.display()))?;
        seal::write(&path)?;
        programming::write(&path)?;
        images.push(Image::measured(name, &path)?);
    }
    let path = build_emulated(way)?;
    let image = Image::measured(budget::EMULATED.to_owned(), &path)?;
    let stack = image.stack.clone();
    images.push(image);
    Ok((images, Emulated { path, stack }))
}
