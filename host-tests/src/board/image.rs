//! The image as it is flashed.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result, ensure};
use object::{Object, ObjectSegment};

/// Pieces of an ELF file that are programmed into flash.
#[derive(Clone, Debug)]
pub struct Image {
    /// Address and bytes.
    pub pieces: Vec<(u32, Vec<u8>)>,
}

impl Image {
    /// Reads an ELF file.
    ///
    /// # Errors
    /// If it is none, or has nothing for the flash.
    pub fn read(path: &Path) -> Result<Self> {
        let bytes =
            fs::read(path).with_context(|| format!("can't read the image {}", path.display()))?;
        let file = object::read::elf::ElfFile32::<object::Endianness>::parse(&*bytes)
            .with_context(|| format!("{} is no ELF file", path.display()))?;
        let endian = file.endian();
        let mut pieces = Vec::new();
        for segment in file.segments() {
            use object::read::elf::ProgramHeader;
            let header = segment.elf_program_header();
            let data = segment.data()?.to_vec();
            if !data.is_empty() {
                pieces.push((header.p_paddr(endian), data));
            }
        }
        ensure!(
            pieces
                .iter()
                .any(|(address, _)| *address == super::part::FLASH),
            "{} has no vector table at the beginning of flash",
            path.display()
        );
        Ok(Self { pieces })
    }
}
