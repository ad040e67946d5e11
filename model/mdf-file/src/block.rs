//! Blocks of MDF 4: their kinds, lengths and links.

use falcon_mdf::Channel;
use falcon_mdf::io::ByteSource;

/// Size of the head of a block: its kind, its length and its number of links.
pub const HEAD: u64 = 24;
/// Size of a link.
pub const LINK: u64 = 8;
/// Longest text of a unit.
const LONGEST: u64 = 512;
/// Index of the link to the conversion in a channel's block, and of that to the unit in a conversion's block.
const CONVERSION: usize = 4;
const UNIT: usize = 1;

/// Head and links of a block.
pub struct Block {
    /// Its byte offset.
    pub at: u64,
    /// Its kind, as `##DG`.
    pub kind: [u8; 4],
    /// Its length with its head; that of a block of data may exceed the file.
    pub length: u64,
    /// Byte offsets of other blocks; 0 without one.
    pub links: Vec<u64>,
}

/// The number of 64 bits at a byte offset; `None` behind the end.
pub fn number(source: &dyn ByteSource, at: u64) -> Option<u64> {
    let bytes = source.read_bytes(at, 8).ok()?;
    Some(u64::from_le_bytes(bytes.as_ref().try_into().ok()?))
}

/// Byte offset of a link of the block at `at`.
pub fn place_of_link(at: u64, index: usize) -> u64 {
    at.saturating_add(HEAD + LINK * index as u64)
}

impl Block {
    /// The block at a byte offset; `None` if its head or links are not in the file.
    pub fn at(source: &dyn ByteSource, at: u64) -> Option<Self> {
        let head = source.read_bytes(at, HEAD as usize).ok()?;
        let kind = head.get(..4)?.try_into().ok()?;
        let length = number(source, at.checked_add(8)?)?;
        let links = number(source, at.checked_add(16)?)?;
        let size = links
            .checked_mul(LINK)
            .filter(|size| *size <= source.len())?;
        let links = source
            .read_bytes(at.checked_add(HEAD)?, size as usize)
            .ok()?;
        let (links, _) = links.as_chunks();
        let links = links.iter().copied().map(u64::from_le_bytes).collect();
        Some(Self {
            at,
            kind,
            length,
            links,
        })
    }

    /// Whether it contains samples as they are, and not packed.
    pub fn is_data(&self) -> bool {
        [b"##DT", b"##SD", b"##RD", b"##DV", b"##DI"].contains(&&self.kind)
    }

    /// Whether a link of it refers to data, or to a list of data.
    pub fn leads_to_data(&self, index: usize) -> bool {
        match &self.kind {
            b"##DG" => index == 2,
            b"##CN" => index == 5,
            b"##SR" => index == 1,
            kind => [b"##DL", b"##LD", b"##HL"].contains(&kind),
        }
    }
}

/// The unit of a channel's conversion, which the library does not read; `None` without one, or if a block is damaged.
pub fn unit_of_conversion(source: &dyn ByteSource, channel: &Channel) -> Option<String> {
    let link = |at: u64, kind: &[u8; 4], index: usize| {
        let block = Block::at(source, at).filter(|block| block.kind == *kind)?;
        block.links.get(index).copied().filter(|link| *link != 0)
    };
    let conversion = link(channel.block_offset(), b"##CN", CONVERSION)?;
    let text = Block::at(source, link(conversion, b"##CC", UNIT)?)?;
    let size = text.length.saturating_sub(HEAD).min(LONGEST);
    let bytes = source.read_bytes(text.at + HEAD, size as usize).ok()?;
    let words = String::from_utf8_lossy(&bytes);
    let words = words.split('\0').next().unwrap_or_default();
    let unit = match &text.kind {
        b"##TX" => words,
        b"##MD" => words.split_once("<TX>")?.1.split_once("</TX>")?.0,
        _ => return None,
    };
    let unit = unit.trim();
    (!unit.is_empty()).then(|| unit.to_owned())
}
