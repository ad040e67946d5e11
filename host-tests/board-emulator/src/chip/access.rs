//! Reads and writes of the processor: registers, flash, and the RAM page with a stuck bit.

use super::{CLOCKS_PER_INSTRUCTION, Chip, ECCD, ECCR, POLLING_NS, Stop};
use crate::cpu::Bus;
use crate::part::{CAN, FDCAN_RAM, FLASH, IWDG, PWR, Part, Pin, Port, TIM2};

impl Chip {
    fn read_calibration(&mut self, address: u32, size: u32) -> u32 {
        self.calibration_read_ns.get_or_insert(self.now_ns);
        let stalled = self.flash.stalls_until_ns(address);
        if stalled > self.now_ns {
            self.pass(stalled);
        }
        let offset = address - self.part.data().0;
        let (word, damaged) = self.flash.read(offset, &self.registers);
        if let Some(place) = damaged {
            let eccr = self.part.addresses().flash + ECCR;
            // Address, second bank, and the flag.
            let flags = place & 0x7_FFFF | 1 << 21 | 1 << ECCD;
            self.registers.modify(eccr, 0x7_FFFF, flags);
            self.raise_if_pending();
        }
        part_of(word, offset, size)
    }

    fn read_port(&self, base: u32, offset: u32) -> u32 {
        if offset != 0x10 {
            return self.registers.get(base + offset);
        }
        let port = match (base - self.part.addresses().gpio) / 0x400 {
            0 => Port::A,
            1 => Port::B,
            _ => Port::C,
        };
        (0..16).fold(0, |bits, number| {
            bits | u32::from(self.level(Pin::new(port, number))) << number
        })
    }

    fn level(&self, pin: Pin) -> bool {
        if self.mode(pin) == 1 {
            return self.output(pin);
        }
        if let Some(&level) = self.conditions.levels.get(&pin) {
            return level;
        }
        if let Some((from, _)) = self.conditions.wires.iter().find(|(_, to)| *to == pin) {
            return self.output(*from);
        }
        self.is_pulled_up(pin)
    }

    /// Whether a pin has its pull-up.
    #[must_use]
    pub fn is_pulled_up(&self, pin: Pin) -> bool {
        let pulls = self.port(pin.port) + 0x0C;
        self.registers.field(pulls, 2 * pin.number, 2) == 1
    }

    fn write_port(&mut self, base: u32, offset: u32, value: u32) {
        match offset {
            0x18 => self
                .registers
                .modify(base + 0x14, value >> 16 & 0xFFFF, value & 0xFFFF),
            0x28 => self.registers.modify(base + 0x14, value & 0xFFFF, 0),
            _ => self.registers.set(base + offset, value),
        }
    }

    fn read_word(&mut self, address: u32) -> u32 {
        let places = self.part.addresses();
        let (now_ns, page) = (self.now_ns, address & !0x3FF);
        let offset = address - page;
        if (places.gpio..places.gpio + 0xC00).contains(&address) {
            return self.read_port(page, offset);
        }
        if let Some(index) = self.converter_at(address) {
            let base = places.adc[index];
            let value = self.converters[index].read(address - base, &self.registers, now_ns);
            if address == base {
                self.polled(index);
            }
            return value;
        }
        match page {
            CAN => self.can.read(offset, &self.registers),
            FDCAN_RAM if self.part == Part::Stm32g474 => {
                self.can.read_memory(offset, &self.registers)
            }
            IWDG => self.watchdog.read(offset, now_ns),
            TIM2 => self.tim2.read(offset, &self.registers, now_ns),
            _ if page == places.slow_clock_timer => {
                let slow_clock_hz = self.conditions.slow_clock_hz;
                self.slow_clock
                    .read(offset, &self.registers, slow_clock_hz, now_ns)
            }
            _ if page == places.rcc => self.clocks.read(offset, &self.registers, now_ns),
            _ if page == places.flash => self.flash.read_register(offset, &self.registers, now_ns),
            _ => self.read_system(address),
        }
    }

    /// The end of a conversion was polled.
    fn polled(&mut self, index: usize) {
        if self.converters[index].is_waiting() {
            // No further than to whatever happens next: nothing is skipped.
            let soon = (self.now_ns + POLLING_NS).min(self.next_event_ns);
            self.now_ns = self.now_ns.max(soon);
            return;
        }
        if self
            .converters
            .iter()
            .all(|converter| !converter.is_waiting())
        {
            self.sampled_at.get_or_insert(self.instructions);
        }
    }

    fn stuck_at(&self, address: u32) -> Option<u32> {
        let stuck = self.conditions.stuck_ram?;
        (address & !0xFFF == stuck & !0xFFF).then_some(stuck)
    }

    /// A read from the page of RAM with a stuck bit.
    fn read_stuck(&self, stuck: u32, address: u32) -> u32 {
        let at = (address & 0xFFC) as usize;
        let word = u32::from_le_bytes([0, 1, 2, 3].map(|index| self.stuck_page[at + index]));
        if address & !3 == stuck & !3 {
            word & !(1 << 9)
        } else {
            word
        }
    }

    fn read_system(&self, address: u32) -> u32 {
        let unique_id = self.part.addresses().unique_id;
        match address.checked_sub(unique_id) {
            Some(offset @ (0 | 4 | 8)) => self.unique_id[offset as usize / 4],
            _ => self.registers.get(address),
        }
    }

    fn converter_at(&self, address: u32) -> Option<usize> {
        let bases = self.part.addresses().adc;
        bases
            .iter()
            .position(|&base| (base..base + 0x100).contains(&address))
    }

    fn write_word(&mut self, address: u32, value: u32) {
        let places = self.part.addresses();
        let (now_ns, page) = (self.now_ns, address & !0x3FF);
        let offset = address - page;
        let before = self.registers.get(address);
        if (places.gpio..places.gpio + 0xC00).contains(&address) {
            self.write_port(page, offset, value);
            self.watch_outputs();
            return;
        }
        if page == places.flash {
            let wrong = self
                .flash
                .write_register(offset, value, &mut self.registers, now_ns);
            self.violations.extend(wrong);
            if offset == ECCR && self.part == Part::Stm32g474 {
                // Writing ones clears the flags.
                self.registers.set(address, before & !(value & 0xC000_0000));
            }
            return;
        }
        self.registers.set(address, value);
        if let Some(index) = self.converter_at(address) {
            let base = places.adc[index];
            let values = (before, value);
            let wrong =
                self.converters[index].written(address - base, values, &mut self.registers, now_ns);
            self.violations.extend(wrong);
            self.convert_regular(index);
            return;
        }
        // The converters' clock.
        if places.adc_common.contains(&(address & !0xFF)) {
            self.retime();
            return;
        }
        match page {
            CAN => self.can.written(offset, value, &mut self.registers, now_ns),
            IWDG => {
                let wrong = self.watchdog.write(offset, value, now_ns);
                self.violations.extend(wrong);
            }
            PWR => self.retime(),
            _ if page == places.tim1 => {
                self.pwm
                    .written(offset, &mut self.registers, self.timer_hz[1], now_ns);
                self.note_drive(offset);
                self.watch_outputs();
            }
            _ if page == places.rcc => {
                let start = self.conditions.crystal_start_ns;
                self.clocks.written(offset, value, now_ns, start);
                self.clear_reset_flags(offset, value);
                self.retime();
                self.check_flash_speed();
            }
            TIM2 => self.tim2.settle(&self.registers, self.timer_hz[0], now_ns),
            _ if page == places.slow_clock_timer => self.retime(),
            _ => self.write_system(address, value),
        }
    }

    /// The compare value of the second coil is the last of a millisecond.
    fn note_drive(&mut self, offset: u32) {
        /// `CCR2`.
        const LAST: u32 = 0x38;
        if offset == LAST
            && let Some(sampled) = self.sampled_at.take()
        {
            let took = self.instructions - sampled;
            self.instructions_to_drive = self.instructions_to_drive.max(took);
        }
    }

    fn clear_reset_flags(&mut self, offset: u32, value: u32) {
        let (register, bit) = match self.part {
            Part::Stm32f405 => (0x74, 24),
            Part::Stm32g474 => (0x94, 23),
        };
        if offset == register && value >> bit & 1 == 1 {
            self.registers
                .set(self.part.addresses().rcc + register, value & 0b11);
        }
    }

    fn write_system(&mut self, address: u32, value: u32) {
        /// `AIRCR`, its key and its request for a reset.
        const AIRCR: u32 = 0xE000_ED0C;
        if address == AIRCR && value >> 16 == 0x05FA && value >> 2 & 1 == 1 {
            self.stop = Some(Stop::Software);
        }
    }
}

/// The bytes of a word that a read of `size` bytes at an address gives.
fn part_of(word: u32, address: u32, size: u32) -> u32 {
    word >> (8 * (address % 4)) & (u32::MAX >> (32 - 8 * size))
}

impl Bus for Chip {
    fn read(&mut self, address: u32, size: u32) -> u32 {
        let (data, bytes) = self.part.data();
        if (data..data + bytes).contains(&address) {
            return self.read_calibration(address, size);
        }
        let word = match self.stuck_at(address) {
            Some(stuck) => self.read_stuck(stuck, address),
            None => self.read_word(address & !3),
        };
        part_of(word, address, size)
    }

    fn write(&mut self, address: u32, size: u32, value: u32) {
        let (data, bytes) = self.part.data();
        if (data..data + bytes).contains(&address) {
            let offset = address - data;
            let wrong = self
                .flash
                .write(offset, size, value, &mut self.registers, self.now_ns);
            self.violations.extend(wrong);
        } else if self.stuck_at(address).is_some() {
            let at = (address & 0xFFF) as usize;
            let bytes = value.to_le_bytes();
            self.stuck_page[at..at + size as usize].copy_from_slice(&bytes[..size as usize]);
        } else if size == 4 {
            self.write_word(address, value);
        } else {
            let shift = 8 * (address % 4);
            let mask = (1_u32 << (8 * size)) - 1;
            let old = self.registers.get(address & !3);
            self.write_word(
                address & !3,
                old & !(mask << shift) | (value & mask) << shift,
            );
        }
        self.schedule();
    }

    fn execute(&mut self, address: u32, instructions: u32) {
        let stalled = self.flash.stalls_until_ns(address);
        if stalled > self.now_ns && address >= FLASH {
            self.pass(stalled);
        }
        self.instructions += u64::from(instructions);
        let end_ns = self.now_ns + f64::from(instructions) * CLOCKS_PER_INSTRUCTION * self.cycle_ns;
        if self.stop.is_none() {
            self.pass(end_ns);
        }
    }

    fn fault(&mut self, address: u32, write: bool) {
        let what = if write { "write to" } else { "read from" };
        self.violations
            .insert(format!("{what} {address:#010x}, where nothing is"));
        self.stop = Some(Stop::HardFault);
    }

    fn exception_return(&mut self) {
        self.stop = Some(Stop::ExceptionReturn);
    }

    fn stops(&self) -> bool {
        self.stop.is_some()
    }
}
