//! The image as it is flashed.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result, bail, ensure};
use object::{Object, ObjectSegment};

/// Pieces of an ELF file that are programmed into flash.
#[derive(Clone, Debug)]
pub struct Image {
    /// Address and bytes.
    pub pieces: Vec<(u32, Vec<u8>)>,
}

/// Words in front of the checksum that an image carries of itself (`firmware/ecu/src/bin/ecu/board/image_check.rs`).
const MAGIC: [u32; 2] = [0x4B43_4548, 0xA5C3_1E7D];

impl Image {
    /// The image as cargo builds it: without its checksum.
    ///
    /// # Errors
    /// If it has no place for one.
    pub fn unsealed(&self) -> Result<Self> {
        let magic: Vec<u8> = MAGIC.iter().flat_map(|word| word.to_le_bytes()).collect();
        let mut image = self.clone();
        for (_, bytes) in &mut image.pieces {
            let place = bytes
                .windows(magic.len())
                .position(|words| words == magic)
                .map(|place| place + magic.len());
            if let Some(seal) = place.and_then(|place| bytes.get_mut(place..place + 4)) {
                seal.fill(0xFF);
                return Ok(image);
            }
        }
        bail!("the image has no place for its checksum")
    }

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
