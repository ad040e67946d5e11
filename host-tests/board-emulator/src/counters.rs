//! Free-running timers: TIM2, and the timer that captures the edges of the low-speed oscillator.

use super::part::Part;
use super::registers::Registers;

const CR1: u32 = 0x00;
const SR: u32 = 0x10;
const CNT: u32 = 0x24;
const PSC: u32 = 0x28;

/// A timer that counts up.
#[derive(Clone, Debug)]
pub struct Counter {
    base: u32,
    counts: f64,
    since_ns: f64,
    hz: f64,
    runs: bool,
    mask: u32,
}

impl Counter {
    /// A timer at `base` whose counter has the bits of `mask`.
    #[must_use]
    pub const fn new(base: u32, mask: u32) -> Self {
        Self {
            base,
            counts: 0.0,
            since_ns: 0.0,
            hz: 0.0,
            runs: false,
            mask,
        }
    }

    /// The rate may have changed.
    pub fn settle(&mut self, registers: &Registers, timer_hz: f64, now_ns: f64) {
        self.counts = self.exact(now_ns);
        self.since_ns = now_ns;
        self.runs = registers.bit(self.base + CR1, 0);
        self.hz = timer_hz / (f64::from(registers.get(self.base + PSC)) + 1.0);
    }

    fn exact(&self, at_ns: f64) -> f64 {
        if self.runs {
            self.counts + (at_ns - self.since_ns) * 1e-9 * self.hz
        } else {
            self.counts
        }
    }

    /// The counter at some time.
    #[must_use]
    pub fn at(&self, at_ns: f64) -> u32 {
        (self.exact(at_ns).max(0.0) as u64 & u64::from(self.mask)) as u32
    }

    /// A read at `offset`.
    #[must_use]
    pub fn read(&self, offset: u32, registers: &Registers, now_ns: f64) -> u32 {
        match offset {
            CNT => self.at(now_ns),
            _ => registers.get(self.base + offset),
        }
    }
}

/// The timer whose input is the low-speed oscillator.
#[derive(Clone, Debug)]
pub struct SlowClockCapture {
    part: Part,
    base: u32,
    /// Its counter.
    pub counter: Counter,
    /// The edge that was captured last at the time of the last read.
    seen: u64,
}

impl SlowClockCapture {
    /// TIM5 of the STM32F405, with 32 bits, or TIM16 of the STM32G474, with 16.
    #[must_use]
    pub const fn new(part: Part) -> Self {
        let base = part.addresses().slow_clock_timer;
        let mask = match part {
            Part::Stm32f405 => u32::MAX,
            Part::Stm32g474 => 0xFFFF,
        };
        Self {
            part,
            base,
            counter: Counter::new(base, mask),
            seen: 0,
        }
    }

    /// Whether the oscillator is the input: TIM5 channel 4 (RM0090, 18.4.21) or TIM16 channel 1 (RM0440, 30.6.19).
    fn is_connected(&self, registers: &Registers) -> bool {
        match self.part {
            Part::Stm32f405 => {
                registers.field(self.base + 0x50, 6, 2) == 1 && registers.bit(self.base + 0x20, 12)
            }
            Part::Stm32g474 => {
                registers.field(self.base + 0x5C, 0, 4) == 6 && registers.bit(self.base + 0x20, 0)
            }
        }
    }

    /// Edges between two captures.
    fn divider(&self, registers: &Registers) -> f64 {
        let code = match self.part {
            Part::Stm32f405 => registers.field(self.base + 0x1C, 10, 2),
            Part::Stm32g474 => registers.field(self.base + 0x18, 2, 2),
        };
        f64::from(1_u32 << code)
    }

    /// A read at `offset`; `slow_clock_hz` is the true frequency.
    pub fn read(
        &mut self,
        offset: u32,
        registers: &Registers,
        slow_clock_hz: f64,
        now_ns: f64,
    ) -> u32 {
        let (flag, value) = match self.part {
            Part::Stm32f405 => (4, 0x40),
            Part::Stm32g474 => (1, 0x34),
        };
        if !self.is_connected(registers) || (offset != SR && offset != value) {
            return self.counter.read(offset, registers, now_ns);
        }
        let period_ns = self.divider(registers) / slow_clock_hz * 1e9;
        let edge = (now_ns / period_ns) as u64;
        if offset == SR {
            return u32::from(edge != self.seen) << flag;
        }
        self.seen = edge;
        self.counter.at(edge as f64 * period_ns)
    }
}
