//! The serial number of the part, which distinguishes its node from others on the bus.

use stm32_metapac::UID;

/// 21 bits (the identity number of a NAME): an FNV-1a hash of the 96-bit unique number of the part.
pub fn serial_number() -> u32 {
    const PRIME: u32 = 0x0100_0193;
    let words = [0, 1, 2].map(|index| UID.uid(index).read());
    let hash = words
        .iter()
        .flat_map(|word| word.to_le_bytes())
        .fold(0x811C_9DC5_u32, |hash, byte| {
            (hash ^ u32::from(byte)).wrapping_mul(PRIME)
        });
    (hash ^ (hash >> 21)) & 0x1F_FFFF
}
