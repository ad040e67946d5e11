//! The checksum that a board's image carries of itself (see `firmware/ecu/src/bin/ecu/board/image_check.rs`).

use std::fs;
use std::path::Path;

use anyhow::{Context, Result, ensure};
use crc::{CRC_32_ISO_HDLC, Crc};

use crate::programming;

/// Words in front of the checksum.
const MAGIC: [u32; 2] = [0x4B43_4548, 0xA5C3_1E7D];

/// Writes the checksum of all that is programmed into an ELF file.
pub fn write(image: &Path) -> Result<()> {
    let mut file = fs::read(image).with_context(|| format!("can't read {}", image.display()))?;
    let magic: Vec<u8> = MAGIC.iter().flat_map(|word| word.to_le_bytes()).collect();
    let places: Vec<usize> = (0..file.len().saturating_sub(12))
        .filter(|&at| file[at..at + 8] == magic)
        .collect();
    ensure!(
        places.len() == 1,
        "{} has {} places for its checksum, not one",
        image.display(),
        places.len()
    );
    let place = places[0] + 8;
    // It counts as erased while the checksum is worked out.
    file[place..place + 4].fill(0xFF);
    let (_, bytes) = programming::flash(&file)?;
    let checksum = Crc::<u32>::new(&CRC_32_ISO_HDLC).checksum(&bytes);
    file[place..place + 4].copy_from_slice(&checksum.to_le_bytes());
    fs::write(image, file).with_context(|| format!("can't write {}", image.display()))
}
