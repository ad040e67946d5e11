//! FNV-1a over texts and numbers, at compile time: keys that come from names.

/// Where a hash begins.
pub const START: u32 = 0x811C_9DC5;

/// Goes on with a text, closed by a zero.
pub const fn text(mut hash: u32, text: &str) -> u32 {
    let bytes = text.as_bytes();
    let mut index = 0;
    while index < bytes.len() {
        hash = byte(hash, bytes[index]);
        index += 1;
    }
    byte(hash, 0)
}

/// Goes on with a number.
pub const fn number(mut hash: u32, number: i32) -> u32 {
    let bytes = number.to_le_bytes();
    let mut index = 0;
    while index < bytes.len() {
        hash = byte(hash, bytes[index]);
        index += 1;
    }
    hash
}

const fn byte(hash: u32, byte: u8) -> u32 {
    (hash ^ byte as u32).wrapping_mul(0x0100_0193)
}
