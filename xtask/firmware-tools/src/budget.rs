//! Size budgets of the ECU's images, and their recorded sizes.
//!
//! `firmware/sizes.txt` has a line for each image. An image over its budget, or with a size that differs from its line,
//! is an error; `cargo xtask sizes` updates the lines, and the change is visible in review.

use std::fs;
use std::path::PathBuf;

use anyhow::{Context, Result, bail, ensure};
use arm_build::workspace;

use crate::size::Size;

/// Maximum flash of an image.
const FLASH_BYTES: u64 = 192 * 1024;
/// Maximum RAM of an image: variables and the deepest stack.
const RAM_BYTES: u64 = 48 * 1024;
/// The image without flash limit, as it runs in the emulator.
pub const EMULATED: &str = "emulated";
/// Tolerated growth, per mille.
const GROWTH_PER_MILLE: u64 = 20;
/// The images of the newer of the two compilers are smaller by 46 per mille.
const SHRINKAGE_PER_MILLE: u64 = 80;

const HEADING: &str = "\
# Bytes that the images take: flash, RAM without the stack, and a bound of the stack. Written by `cargo xtask sizes`.
";

/// An image with its sizes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Entry {
    name: String,
    flash: u64,
    ram: u64,
    stack: u64,
}

impl Entry {
    /// The entry of an image, whose stack is at most `stack` bytes deep.
    pub fn new(name: impl Into<String>, size: Size, stack: u64) -> Self {
        Self {
            name: name.into(),
            flash: size.text + size.data,
            ram: size.data + size.bss,
            stack,
        }
    }

    /// The image's name.
    pub fn name(&self) -> &str {
        &self.name
    }

    fn line(&self) -> String {
        let Self {
            name,
            flash,
            ram,
            stack,
        } = self;
        format!("{name} flash {flash} ram {ram} stack {stack}\n")
    }

    fn parse(line: &str) -> Option<Self> {
        let words: Vec<&str> = line.split_whitespace().collect();
        let [name, "flash", flash, "ram", ram, "stack", stack] = words[..] else {
            return None;
        };
        Some(Self {
            name: name.to_owned(),
            flash: flash.parse().ok()?,
            ram: ram.parse().ok()?,
            stack: stack.parse().ok()?,
        })
    }
}

fn path() -> PathBuf {
    workspace::root().join("firmware/sizes.txt")
}

/// Records the sizes of the images.
pub fn write(entries: &[Entry]) -> Result<()> {
    let lines: String = entries.iter().map(Entry::line).collect();
    let path = path();
    fs::write(&path, format!("{HEADING}{lines}"))
        .with_context(|| format!("can't write {}", path.display()))
}

/// Checks the images against their budgets and the recorded sizes.
pub fn check(entries: &[Entry]) -> Result<()> {
    let path = path();
    let text = fs::read_to_string(&path).with_context(|| {
        format!(
            "can't read {}: `cargo xtask sizes` writes it",
            path.display()
        )
    })?;
    let golden: Vec<Entry> = text.lines().filter_map(Entry::parse).collect();
    entries.iter().try_for_each(|entry| judge(entry, &golden))
}

fn judge(entry: &Entry, golden: &[Entry]) -> Result<()> {
    let name = &entry.name;
    let flash_bytes = if name == EMULATED {
        u64::MAX
    } else {
        FLASH_BYTES
    };
    for (what, takes, may) in [
        ("flash", entry.flash, flash_bytes),
        ("RAM with its stack", entry.ram + entry.stack, RAM_BYTES),
    ] {
        ensure!(
            takes <= may,
            "{name} takes {takes} bytes of {what}, and may take {may}"
        );
    }
    let Some(known) = golden.iter().find(|known| known.name == *name) else {
        bail!("firmware/sizes.txt knows no {name}: run `cargo xtask sizes`");
    };
    for (what, takes, took) in [
        ("flash", entry.flash, known.flash),
        ("RAM", entry.ram, known.ram),
        ("stack", entry.stack, known.stack),
    ] {
        let tolerated = if takes > took {
            GROWTH_PER_MILLE
        } else {
            SHRINKAGE_PER_MILLE
        };
        ensure!(
            takes.abs_diff(took) * 1_000 <= took * tolerated,
            "{name} takes {takes} bytes of {what} and took {took}; if that is meant, run `cargo xtask sizes`"
        );
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entry(flash: u64) -> Entry {
        Entry {
            name: "ecu".to_owned(),
            flash,
            ram: 1_088,
            stack: 24_000,
        }
    }

    #[test]
    fn a_line_goes_round() {
        let entry = entry(60_000);
        assert_eq!(Entry::parse(&entry.line()), Some(entry));
        assert_eq!(Entry::parse(HEADING), None);
    }

    #[test]
    fn an_image_over_its_budget_or_away_from_its_line_is_refused() {
        assert!(judge(&entry(60_000), &[entry(59_000)]).is_ok());
        let moved = judge(&entry(60_000), &[entry(50_000)]).unwrap_err();
        assert!(moved.to_string().contains("cargo xtask sizes"), "{moved}");
        let over = judge(&entry(196_609), &[entry(196_609)]).unwrap_err();
        assert!(over.to_string().contains("196608"), "{over}");
        assert!(judge(&entry(60_000), &[]).is_err(), "a new image");
        let deep = Entry {
            stack: 49_000,
            ..entry(60_000)
        };
        let refused = judge(&deep, std::slice::from_ref(&deep)).unwrap_err();
        assert!(
            refused.to_string().contains("50088 bytes of RAM"),
            "{refused}"
        );
    }
}
