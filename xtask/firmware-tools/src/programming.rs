//! Images in the formats of flash programmers: plain bytes, and Intel hexadecimal records.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result, ensure};
use ihex::Record;
use object::LittleEndian;
use object::elf::PT_LOAD;
use object::read::elf::{ElfFile32, ProgramHeader};

/// Bytes of a record.
const RECORD_BYTES: usize = 32;
/// Unit of an extended address.
const BANK_BYTES: usize = 1 << 16;

/// Writes `NAME.bin` and `NAME.hex` beside the image.
pub fn write(image: &Path) -> Result<()> {
    let file = fs::read(image).with_context(|| format!("can't read {}", image.display()))?;
    let (first, bytes) =
        flash(&file).with_context(|| format!("{} is no image", image.display()))?;
    let written = |extension: &str, content: &[u8]| {
        let path = image.with_extension(extension);
        fs::write(&path, content).with_context(|| format!("can't write {}", path.display()))
    };
    written("bin", &bytes)?;
    written("hex", hexadecimal(first, &bytes)?.as_bytes())
}

/// Flash contents of the image with its start address; gaps are filled as erased flash.
pub fn flash(file: &[u8]) -> Result<(u32, Vec<u8>)> {
    let elf = ElfFile32::<LittleEndian>::parse(file)?;
    let mut pieces = Vec::new();
    for header in elf.elf_program_headers() {
        let data = header.data(LittleEndian, file);
        let data = data.ok().context("a segment is cut off")?;
        if header.p_type(LittleEndian) == PT_LOAD && !data.is_empty() {
            pieces.push((header.p_paddr(LittleEndian), data));
        }
    }
    let first = pieces.iter().map(|(address, _)| *address).min();
    let first = first.context("nothing is loaded")?;
    let mut bytes = Vec::new();
    for (address, data) in pieces {
        let at = (address - first) as usize;
        ensure!(
            at < 1 << 24,
            "segments are further apart than a flash is large"
        );
        bytes.resize(bytes.len().max(at + data.len()), 0xFF);
        bytes[at..at + data.len()].copy_from_slice(data);
    }
    Ok((first, bytes))
}

fn hexadecimal(first: u32, bytes: &[u8]) -> Result<String> {
    let mut records = Vec::new();
    let mut bank = None;
    for (index, value) in bytes.chunks(RECORD_BYTES).enumerate() {
        let address = first as usize + index * RECORD_BYTES;
        let upper = u16::try_from(address / BANK_BYTES)?;
        if bank.replace(upper) != Some(upper) {
            records.push(Record::ExtendedLinearAddress(upper));
        }
        records.push(Record::Data {
            offset: u16::try_from(address % BANK_BYTES)?,
            value: value.to_vec(),
        });
    }
    records.push(Record::EndOfFile);
    Ok(ihex::create_object_file_representation(&records)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn records_cross_a_bank_with_a_new_address() {
        let text = hexadecimal(0x0800_FFE0, &[0xAB; 64]).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), 5, "{text}");
        assert!(lines[0].starts_with(":020000040800"), "{text}");
        assert!(lines[1].starts_with(":20FFE000AB"), "{text}");
        assert!(lines[2].starts_with(":020000040801"), "{text}");
        assert!(lines[3].starts_with(":20000000AB"), "{text}");
        assert_eq!(lines[4], ":00000001FF");
    }
}
