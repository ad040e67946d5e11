//! Memory sizes of an image.

use std::fmt;
use std::fs;
use std::path::Path;

use anyhow::{Context, Result};
use object::elf::{SHF_ALLOC, SHF_WRITE, SHT_NOBITS};
use object::{Object, ObjectSection, SectionFlags};

/// Bytes of an image by memory.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Size {
    /// Code and constants, in flash.
    pub text: u64,
    /// Variables with a start value: in RAM, and the values in flash.
    pub data: u64,
    /// Variables that start at zero, in RAM.
    pub bss: u64,
}

impl fmt::Display for Size {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "text {} B, data {} B, bss {} B",
            self.text, self.data, self.bss
        )
    }
}

/// Sizes of the loaded sections.
pub fn of(image: &Path) -> Result<Size> {
    let bytes =
        fs::read(image).with_context(|| format!("can't read the image {}", image.display()))?;
    let file = object::File::parse(&*bytes)
        .with_context(|| format!("{} is no ELF file", image.display()))?;
    let mut size = Size::default();
    for section in file.sections() {
        let SectionFlags::Elf { sh_type, sh_flags } = section.flags() else {
            continue;
        };
        let writable = sh_flags.contains(SHF_WRITE);
        match sh_flags.contains(SHF_ALLOC) {
            false => {}
            true if sh_type == SHT_NOBITS => size.bss += section.size(),
            true if writable => size.data += section.size(),
            true => size.text += section.size(),
        }
    }
    Ok(size)
}
