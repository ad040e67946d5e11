//! Units of conversion blocks in MDF 4, which the library does not read: a channel without a unit has that of its
//! conversion.

use std::fs::File;
use std::io::{Read as _, Seek as _, SeekFrom};
use std::path::Path;

use falcon_mdf::Channel;

/// Size of the head of a block: its kind, its length and its number of links.
const HEAD: u64 = 24;
/// Size of a link.
const LINK: u64 = 8;
/// Longest text of a unit.
const LONGEST: u64 = 512;
/// Index of the link to the conversion in a channel's block, and of that to the unit in a conversion's block.
const CONVERSION: u64 = 4;
const UNIT: u64 = 1;

/// Reads units of a file; none if it cannot be opened.
#[derive(Debug)]
pub struct UnitReader {
    file: Option<File>,
}

/// Head of a block.
struct Head {
    kind: [u8; 4],
    length: u64,
    links: u64,
}

impl UnitReader {
    /// For a file.
    pub fn open(path: &Path) -> Self {
        Self {
            file: File::open(path).ok(),
        }
    }

    /// The unit of a channel's conversion; `None` without one, or if a block is damaged.
    pub fn of_conversion(&mut self, channel: &Channel) -> Option<String> {
        let conversion = self.link(channel.block_offset(), *b"##CN", CONVERSION)?;
        let text = self.link(conversion, *b"##CC", UNIT)?;
        let Head { kind, length, .. } = self.head(text)?;
        let mut bytes = Vec::new();
        let size = length.saturating_sub(HEAD).min(LONGEST);
        let file = self.file.as_mut()?;
        file.take(size).read_to_end(&mut bytes).ok()?;
        let text = String::from_utf8_lossy(&bytes);
        let text = text.split('\0').next().unwrap_or_default();
        let unit = match &kind {
            b"##TX" => text,
            b"##MD" => text.split_once("<TX>")?.1.split_once("</TX>")?.0,
            _ => return None,
        };
        let unit = unit.trim();
        (!unit.is_empty()).then(|| unit.to_owned())
    }

    /// A link of a block; `None` if the block is of another kind, or has no such link.
    fn link(&mut self, at: u64, kind: [u8; 4], index: u64) -> Option<u64> {
        let head = self.head(at)?;
        if head.kind != kind || index >= head.links {
            return None;
        }
        let place = at.checked_add(HEAD + LINK * index)?;
        let file = self.file.as_mut()?;
        file.seek(SeekFrom::Start(place)).ok()?;
        let mut bytes = [0; 8];
        file.read_exact(&mut bytes).ok()?;
        Some(u64::from_le_bytes(bytes)).filter(|link| *link != 0)
    }

    /// The head of a block, behind which the next bytes are read.
    fn head(&mut self, at: u64) -> Option<Head> {
        let file = self.file.as_mut()?;
        file.seek(SeekFrom::Start(at)).ok()?;
        let mut parts = [[0; 8]; 3];
        for part in &mut parts {
            file.read_exact(part).ok()?;
        }
        let [[a, b, c, d, ..], length, links] = parts;
        Some(Head {
            kind: [a, b, c, d],
            length: u64::from_le_bytes(length),
            links: u64::from_le_bytes(links),
        })
    }
}
