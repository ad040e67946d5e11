//! The flash that holds the calibration and the log of faults, and its controller: keys, erasing, programming, fetch stalls, error correction
//! and data cache.

use std::collections::{HashMap, HashSet};

use super::part::Part;
use super::registers::Registers;

/// Time to erase a sector or page and to program a word or double word, ns (data sheets: 32-bit parallelism, maximum).
const fn erase_ns(part: Part) -> f64 {
    match part {
        Part::Stm32f405 => 2e9,
        Part::Stm32g474 => 24.5e6,
    }
}

const fn program_ns(part: Part) -> f64 {
    match part {
        Part::Stm32f405 => 100e3,
        Part::Stm32g474 => 90e3,
    }
}

/// An operation that changes the contents of the flash.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Operation {
    /// A sector or page of the data is erased.
    Erase {
        /// Its number in the data's place.
        piece: u32,
    },
    /// A word or double word is programmed.
    Program {
        /// Where.
        offset: u32,
        /// Kind.
        bytes: Vec<u8>,
    },
}

/// How far an operation comes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extent {
    /// All of it is done.
    Whole,
    /// Power is cut in the middle: some of the bits have changed, and error correction, where there is one, fails.
    Half,
}

/// A power cut, and the contents that it leaves.
pub type Cut = (String, Contents);

/// Contents of the flash, which survive a power cut.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Contents {
    /// Bytes of the data's place.
    pub bytes: Vec<u8>,
    /// Double words whose error correction fails, by their offset.
    pub damaged: HashSet<u32>,
}

impl Contents {
    /// Erased flash.
    #[must_use]
    pub fn erased(part: Part) -> Self {
        Self {
            bytes: vec![0xFF; part.data().1 as usize],
            damaged: HashSet::new(),
        }
    }

    /// Does an operation, or half of it.
    pub fn apply(&mut self, part: Part, operation: &Operation, extent: Extent) {
        let corrects = part == Part::Stm32g474;
        match operation {
            Operation::Erase { piece } => {
                let bytes = part.erase_bytes();
                let range = (piece * bytes) as usize..((piece + 1) * bytes) as usize;
                if extent == Extent::Whole {
                    self.damaged
                        .retain(|&offset| !range.contains(&(offset as usize)));
                    self.bytes[range].fill(0xFF);
                    return;
                }
                for at in range {
                    self.bytes[at] |= (at.wrapping_mul(0x9E37_79B9) >> 13) as u8;
                    if corrects && at % 24 == 0 {
                        self.damaged.insert(at as u32 & !7);
                    }
                }
            }
            Operation::Program { offset, bytes } => {
                let at = *offset as usize;
                for (index, (target, &byte)) in self.bytes[at..].iter_mut().zip(bytes).enumerate() {
                    // Half of the zeros are programmed.
                    let kept = match extent {
                        Extent::Whole => 0,
                        Extent::Half => 0xA5_u8.rotate_left(index as u32),
                    };
                    *target &= byte | kept;
                }
                if corrects && extent == Extent::Half {
                    self.damaged.insert(*offset);
                }
            }
        }
    }

    /// What a power cut before and in the middle of each operation leaves, and then what all of them leave: with the number
    /// of the operation, and when.
    #[must_use]
    pub fn cut_in(&self, part: Part, operations: &[Operation]) -> (Vec<Cut>, Self) {
        let mut contents = self.clone();
        let mut cuts = Vec::new();
        for (number, operation) in operations.iter().enumerate() {
            let mut half = contents.clone();
            half.apply(part, operation, Extent::Half);
            cuts.push((
                format!("before operation {number}, {operation:?}"),
                contents.clone(),
            ));
            cuts.push((format!("in operation {number}, {operation:?}"), half));
            contents.apply(part, operation, Extent::Whole);
        }
        (cuts, contents)
    }

    /// The word at an offset.
    #[must_use]
    pub fn word(&self, offset: u32) -> u32 {
        let at = offset as usize & !3;
        u32::from_le_bytes([0, 1, 2, 3].map(|index| self.bytes[at + index]))
    }
}

/// Flash and its controller.
#[derive(Clone, Debug)]
pub struct Flash {
    part: Part,
    base: u32,
    /// Contents.
    pub contents: Contents,
    key: u32,
    unlocked: bool,
    option_key: u32,
    options_unlocked: bool,
    /// The operation that is going on ends then, ns.
    busy_until_ns: f64,
    /// First half of a double word.
    half: Option<(u32, u32)>,
    /// Operations since the last reset.
    pub operations: Vec<Operation>,
    /// Data that the cache would still give, by word offset.
    cached: HashMap<u32, u32>,
    /// Option bytes: the factory's.
    pub options: u32,
}

const CR_LOCK: u32 = 31;

impl Flash {
    /// After a reset.
    #[must_use]
    pub fn new(part: Part, contents: Contents) -> Self {
        Self {
            part,
            base: part.addresses().flash,
            contents,
            key: 0,
            unlocked: false,
            option_key: 0,
            options_unlocked: false,
            busy_until_ns: 0.0,
            half: None,
            operations: Vec::new(),
            cached: HashMap::new(),
            options: match part {
                Part::Stm32f405 => 0x0FFF_AAED,
                Part::Stm32g474 => 0xFFEF_F8AA,
            },
        }
    }

    /// Offsets of status and control register.
    const fn status(&self) -> u32 {
        match self.part {
            Part::Stm32f405 => 0x0C,
            Part::Stm32g474 => 0x10,
        }
    }

    const fn control(&self) -> u32 {
        match self.part {
            Part::Stm32f405 => 0x10,
            Part::Stm32g474 => 0x14,
        }
    }

    /// Until when fetches from `address` and reads from the data wait, ns.
    #[must_use]
    pub fn stalls_until_ns(&self, address: u32) -> f64 {
        let (data, bytes) = self.part.data();
        let stalls = match self.part {
            Part::Stm32f405 => (0x0800_0000..0x0810_0000).contains(&address),
            // The other bank can be read meanwhile.
            Part::Stm32g474 => (0x0804_0000..data + bytes).contains(&address),
        };
        if stalls { self.busy_until_ns } else { 0.0 }
    }

    /// A read of a register.
    #[must_use]
    pub fn read_register(&self, offset: u32, registers: &Registers, now_ns: f64) -> u32 {
        let stored = registers.get(self.base + offset);
        if offset == self.status() {
            return stored | u32::from(now_ns < self.busy_until_ns) << 16;
        }
        if offset == self.control() {
            return stored & !(1 << CR_LOCK | 1 << 16) | u32::from(!self.unlocked) << CR_LOCK;
        }
        match (self.part, offset) {
            (Part::Stm32f405, 0x14) | (Part::Stm32g474, 0x20) => self.options,
            _ => stored,
        }
    }

    /// A write of a register; returns its fault, if any.
    pub fn write_register(
        &mut self,
        offset: u32,
        value: u32,
        registers: &mut Registers,
        now_ns: f64,
    ) -> Option<String> {
        let address = self.base + offset;
        let (key, option_key) = match self.part {
            Part::Stm32f405 => (0x04, 0x08),
            Part::Stm32g474 => (0x08, 0x0C),
        };
        if offset == key {
            return self.take_key(value);
        }
        if offset == option_key {
            self.option_key = self.option_key.wrapping_add(value);
            self.options_unlocked = true;
            return None;
        }
        if offset == self.status() {
            // Writing ones clears.
            registers.modify(address, value, 0);
            return None;
        }
        if offset == self.control() {
            return self.write_control(value, registers, now_ns);
        }
        if offset == 0 {
            // Resetting the data cache is possible while it is off.
            if value >> 12 & 1 == 1 {
                if registers.bit(address, 10) || value >> 10 & 1 == 1 {
                    return Some("the data cache is reset while it is on".into());
                }
                self.cached.clear();
            }
        }
        let programs_options = match self.part {
            Part::Stm32f405 => offset == 0x14 && value >> 1 & 1 == 1,
            Part::Stm32g474 => false,
        };
        registers.set(address, value);
        if programs_options {
            return self.program_options(now_ns);
        }
        None
    }

    fn program_options(&mut self, now_ns: f64) -> Option<String> {
        self.busy_until_ns = now_ns + 500e6;
        Some("the application programs option bytes".into())
    }

    fn take_key(&mut self, value: u32) -> Option<String> {
        match (self.key, value) {
            (0, 0x4567_0123) => self.key = 1,
            (1, 0xCDEF_89AB) => {
                self.key = 0;
                self.unlocked = true;
            }
            _ => {
                self.key = 2;
                return Some("a wrong key locks the flash until the next reset".into());
            }
        }
        None
    }

    fn write_control(
        &mut self,
        value: u32,
        registers: &mut Registers,
        now_ns: f64,
    ) -> Option<String> {
        let address = self.base + self.control();
        if !self.unlocked {
            return Some("the locked control register of the flash is written".into());
        }
        if now_ns < self.busy_until_ns {
            return Some("the flash's control register is written while it is busy".into());
        }
        registers.set(address, value & !(1 << 16));
        if value >> CR_LOCK & 1 == 1 {
            self.unlocked = false;
            return None;
        }
        if self.part == Part::Stm32g474 && value >> 17 & 1 == 1 {
            return self.program_options(now_ns);
        }
        if value >> 16 & 1 == 0 {
            return None;
        }
        match value & 0b111 {
            0b010 => self.erase(value, now_ns),
            _ => Some(format!("the flash is started with {value:#010x}")),
        }
    }

    /// Erases the sector or page that the control register selects.
    fn erase(&mut self, control: u32, now_ns: f64) -> Option<String> {
        let (kind, number, first, pieces) = match self.part {
            Part::Stm32f405 => ("sector", control >> 3 & 0xF, 8, 4),
            Part::Stm32g474 => ("page", control >> 3 & 0x7F, 122, 6),
        };
        let is_in_bank = self.part == Part::Stm32f405 || control >> 11 & 1 == 1;
        match number.checked_sub(first) {
            Some(piece) if piece < pieces && is_in_bank => {
                self.change(Operation::Erase { piece }, now_ns + erase_ns(self.part))
            }
            _ => Some(format!("{kind} {number} of the program is erased")),
        }
    }

    fn change(&mut self, operation: Operation, end_ns: f64) -> Option<String> {
        self.contents.apply(self.part, &operation, Extent::Whole);
        self.operations.push(operation);
        self.busy_until_ns = end_ns;
        None
    }

    /// A write to the data's place; returns its fault, if any.
    pub fn write(
        &mut self,
        offset: u32,
        size: u32,
        value: u32,
        registers: &mut Registers,
        now_ns: f64,
    ) -> Option<String> {
        let control = registers.get(self.base + self.control());
        if control & 1 == 0 || !self.unlocked || size != 4 || !offset.is_multiple_of(4) {
            return Some(format!(
                "flash is written at {offset:#x} without programming"
            ));
        }
        // The write waits for the operation before.
        let now_ns = now_ns.max(self.busy_until_ns);
        match self.part {
            Part::Stm32f405 if control >> 8 & 3 != 2 => {
                Some("words are programmed with another parallelism".into())
            }
            Part::Stm32f405 => self.program(offset, &value.to_le_bytes(), now_ns),
            Part::Stm32g474 => match self.half.take() {
                None if offset.is_multiple_of(8) => {
                    self.half = Some((offset, value));
                    None
                }
                Some((first, low)) if first + 4 == offset => {
                    let double = u64::from(value) << 32 | u64::from(low);
                    self.program(first, &double.to_le_bytes(), now_ns)
                }
                _ => Some("a double word is programmed out of order".into()),
            },
        }
    }

    fn program(&mut self, offset: u32, bytes: &[u8], now_ns: f64) -> Option<String> {
        let at = offset as usize;
        let blank = self.contents.bytes[at..at + bytes.len()]
            .iter()
            .all(|&byte| byte == 0xFF);
        if self.part == Part::Stm32g474 && (!blank || self.contents.damaged.contains(&offset)) {
            return Some(format!(
                "the double word at {offset:#x} is programmed twice"
            ));
        }
        let bytes = bytes.to_vec();
        self.change(
            Operation::Program { offset, bytes },
            now_ns + program_ns(self.part),
        )
    }

    /// A read of a word from the data's place: the word, and the address in its bank if error correction fails.
    pub fn read(&mut self, offset: u32, registers: &Registers) -> (u32, Option<u32>) {
        let word_offset = offset & !3;
        let double = offset & !7;
        if self.contents.damaged.contains(&double) {
            let address = self.part.data().0 + double - 0x0804_0000;
            return (self.contents.word(word_offset) ^ 0x0101_0101, Some(address));
        }
        let word = self.contents.word(word_offset);
        let is_cached = registers.bit(self.base, 10);
        if is_cached {
            (*self.cached.entry(word_offset).or_insert(word), None)
        } else {
            (word, None)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const KEYS: [u32; 2] = [0x4567_0123, 0xCDEF_89AB];

    fn flash(part: Part) -> (Flash, Registers) {
        let mut registers = Registers::default();
        // Both caches on.
        registers.set(part.addresses().flash, 0x600);
        (Flash::new(part, Contents::erased(part)), registers)
    }

    fn unlock(flash: &mut Flash, registers: &mut Registers, key: u32) {
        for value in KEYS {
            assert_eq!(flash.write_register(key, value, registers, 0.0), None);
        }
    }

    #[test]
    fn a_locked_flash_refuses_and_a_wrong_key_keeps_it_locked() {
        let (mut flash, mut registers) = flash(Part::Stm32f405);
        let refused = flash.write_register(0x10, 1, &mut registers, 0.0);
        assert!(refused.is_some());
        let wrong = flash.write_register(0x04, 1, &mut registers, 0.0);
        assert!(wrong.is_some());
        let after = flash.write_register(0x04, KEYS[0], &mut registers, 0.0);
        assert!(after.is_some());
    }

    #[test]
    fn the_data_cache_gives_old_data_until_it_is_reset() {
        let part = Part::Stm32f405;
        let (mut flash, mut registers) = flash(part);
        assert_eq!(flash.read(0, &registers), (u32::MAX, None));
        unlock(&mut flash, &mut registers, 0x04);
        // Programming by words of 32 bits.
        flash.write_register(0x10, 0x201, &mut registers, 0.0);
        assert_eq!(flash.write(0, 4, 0x1234_5678, &mut registers, 0.0), None);
        assert_eq!(flash.read(0, &registers), (u32::MAX, None), "stale");
        flash.write_register(0, 0x200, &mut registers, 0.0);
        flash.write_register(0, 0x1200, &mut registers, 0.0);
        flash.write_register(0, 0x600, &mut registers, 0.0);
        assert_eq!(flash.read(0, &registers), (0x1234_5678, None));
    }

    #[test]
    fn half_a_double_word_fails_its_error_correction_until_it_is_erased() {
        let part = Part::Stm32g474;
        let mut contents = Contents::erased(part);
        let program = Operation::Program {
            offset: 8,
            bytes: vec![0; 8],
        };
        contents.apply(part, &program, Extent::Half);
        let (mut flash, registers) = flash(part);
        flash.contents = contents;
        let (_, failed_at) = flash.read(12, &registers);
        assert_eq!(failed_at, Some(0x3_D008));
        let erase = Operation::Erase { piece: 0 };
        flash.contents.apply(part, &erase, Extent::Whole);
        assert_eq!(flash.read(12, &registers), (u32::MAX, None));
    }

    #[test]
    fn the_other_bank_can_be_read_while_one_is_busy() {
        let (mut flash, mut registers) = flash(Part::Stm32g474);
        unlock(&mut flash, &mut registers, 0x08);
        // Page 124 of the second bank.
        let erase = 1 << 1 | 124 << 3 | 1 << 11 | 1 << 16;
        assert_eq!(flash.write_register(0x14, erase, &mut registers, 0.0), None);
        assert_eq!(flash.stalls_until_ns(0x0800_1000), 0.0);
        assert!(flash.stalls_until_ns(0x0807_E000) > 20e6);
    }
}
