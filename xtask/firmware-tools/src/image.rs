//! Finishes the images that cargo has built: checksums, formats of flash programmers, sizes and stacks.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};
use arm_build::images::{BOARDS, build_all, emulated, of_board};
use arm_build::toolchain::Way;
use image_stack::Bound;

use crate::budget::{self, Entry};
use crate::{programming, seal, size};

/// Builds and finishes all images, and checks them against their budgets.
///
/// The stack bound of each image is written beside it; the tests that run the emulator read the one of its image.
pub fn build(way: Way) -> Result<()> {
    let images = finished(way)?;
    let entries: Vec<Entry> = images.iter().map(|image| image.entry.clone()).collect();
    budget::check(&entries)?;
    for image in images {
        let path = image.path.with_extension("stack");
        fs::write(&path, image.stack.bytes().to_string())
            .with_context(|| format!("can't write {}", path.display()))?;
    }
    Ok(())
}

/// Builds the images and records their sizes.
pub fn write_sizes(way: Way) -> Result<()> {
    let entries: Vec<Entry> = finished(way)?
        .into_iter()
        .map(|image| image.entry)
        .collect();
    budget::write(&entries)
}

/// Builds the images and prints their maximum stack depths with the calls.
pub fn show_stacks(way: Way) -> Result<()> {
    for image in finished(way)? {
        println!("\n{}\n{}", image.entry.name(), image.stack);
    }
    Ok(())
}

/// A built image.
struct Image {
    path: PathBuf,
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
        Ok(Self {
            path: path.to_owned(),
            entry: Entry::new(name, size, stack.bytes()),
            stack,
        })
    }
}

/// Builds an image for each board, as ELF, as plain bytes and as Intel HEX, and the one for the emulator.
fn finished(way: Way) -> Result<Vec<Image>> {
    build_all(way)?;
    let of_boards = BOARDS.iter().map(|board| {
        let path = of_board(way, board);
        seal::write(&path)?;
        programming::write(&path)?;
        let image = Image::measured(format!("ecu-{board}"), &path)?;
        // Whatever leads to a panic in a flashed image would be a fault of the program.
        ensure!(
            image.stack.panics.is_empty(),
            "{} can panic:\n  {}\nuse `get`, patterns, and saturating or checked arithmetic there",
            path.display(),
            image.stack.panics.join("\n  ")
        );
        Ok(image)
    });
    let emulated =
        std::iter::once_with(|| Image::measured(budget::EMULATED.to_owned(), &emulated(way)));
    of_boards.chain(emulated).collect()
}
