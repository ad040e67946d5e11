//! Number of instructions in the blocks of code that the processor executes.

use std::collections::HashMap;

/// How many instructions the blocks have that were met so far: by address, which is even, and size in bytes.
#[derive(Default)]
pub struct BlockCounts {
    known: HashMap<(u32, u32), u32>,
}

impl BlockCounts {
    /// The number of a block that was met before.
    pub fn known(&self, address: u32, size: u32) -> Option<u32> {
        self.known.get(&(address, size)).copied()
    }

    /// Keeps the number of a block.
    pub fn learn(&mut self, address: u32, size: u32, count: u32) {
        self.known.insert((address, size), count);
    }
}

/// Number of instructions in a piece of Thumb code.
#[must_use]
pub fn instructions(code: &[u8]) -> u32 {
    let mut halfwords = code.as_chunks::<2>().0.iter();
    let mut count = 0;
    while let Some(&[_, high]) = halfwords.next() {
        // 0b11101, 0b11110 and 0b11111 begin an instruction of 32 bits (ARMv7-M, A5.1).
        if high >> 3 >= 0b11101 {
            halfwords.next();
        }
        count += 1;
    }
    count
}

#[cfg(test)]
mod tests {
    use super::instructions;

    #[test]
    fn wide_instructions_count_once() {
        // nop; movw r0, #1; bx lr
        let code = [0x00, 0xBF, 0x40, 0xF2, 0x01, 0x00, 0x70, 0x47];
        assert_eq!(instructions(&code), 3);
    }
}
