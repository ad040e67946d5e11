//! TIM1 as the image sets it up: two pulse-width outputs, and the trigger of the converters.

use super::part::Part;
use super::registers::Registers;

const CR1: u32 = 0x00;
const CR2: u32 = 0x04;
const CCMR1: u32 = 0x18;
const CCER: u32 = 0x20;
const ARR: u32 = 0x2C;
const PSC: u32 = 0x28;
const RCR: u32 = 0x30;
const CCR1: u32 = 0x34;
const BDTR: u32 = 0x44;

/// Main output enable.
pub const MOE: u32 = 15;
/// Break enable.
pub const BKE: u32 = 12;
/// Break polarity: active high.
pub const BKP: u32 = 13;

/// The timer.
#[derive(Clone, Debug)]
pub struct Pwm {
    base: u32,
    /// The next update, and with it the trigger, ns.
    pub next_update_ns: f64,
    /// Updates since the start.
    pub updates: u64,
    stopped: bool,
}

impl Pwm {
    /// After a reset.
    #[must_use]
    pub const fn new(part: Part) -> Self {
        Self {
            base: part.addresses().tim1,
            next_update_ns: f64::INFINITY,
            updates: 0,
            stopped: false,
        }
    }

    /// Half a pulse: from one turning point of the counter to the next, ns.
    #[must_use]
    pub fn half_pulse_ns(&self, registers: &Registers, timer_hz: f64) -> f64 {
        let word = |offset| f64::from(registers.get(self.base + offset));
        word(ARR) * (word(PSC) + 1.0) / timer_hz * 1e9
    }

    /// Time between two triggers, ns.
    #[must_use]
    pub fn update_ns(&self, registers: &Registers, timer_hz: f64) -> f64 {
        let repetitions = f64::from(registers.get(self.base + RCR) + 1);
        self.half_pulse_ns(registers, timer_hz) * repetitions
    }

    /// After a write at `offset`.
    pub fn written(&mut self, offset: u32, registers: &mut Registers, timer_hz: f64, now_ns: f64) {
        if offset == CR1 {
            let runs = registers.bit(self.base + CR1, 0);
            if runs && self.next_update_ns == f64::INFINITY {
                self.next_update_ns = now_ns + self.update_ns(registers, timer_hz);
            } else if !runs {
                self.next_update_ns = f64::INFINITY;
            }
        }
        if offset == 0x14 {
            // An update by software resets nothing that matters here.
            registers.set(self.base + 0x14, 0);
        }
    }

    /// The update is there; true if it triggers the converters.
    pub fn update(&mut self, registers: &Registers, timer_hz: f64) -> bool {
        self.next_update_ns += self.update_ns(registers, timer_hz);
        self.updates += 1;
        registers.field(self.base + CR2, 4, 3) == 0b010
    }

    /// The clock has another rate now: the rest of the time goes at it.
    pub fn rescale(&mut self, factor: f64, now_ns: f64) {
        if self.next_update_ns.is_finite() {
            self.next_update_ns = now_ns + (self.next_update_ns - now_ns) * factor;
        }
    }

    /// A debugger has halted the processor, or lets it go on.
    pub fn halt(&mut self, halted: bool) {
        self.stopped = halted;
    }

    /// The break input becomes active; the outputs are cut by hardware if the image has enabled it.
    pub fn take_break(&mut self, registers: &mut Registers) {
        if registers.bit(self.base + BDTR, BKE) && registers.bit(self.base + BDTR, BKP) {
            registers.modify(self.base + BDTR, 1 << MOE, 0);
        }
    }

    /// Share of the time for which the output of a channel, 0 or 1, is high.
    #[must_use]
    pub fn duty(&self, channel: u32, registers: &Registers) -> f64 {
        let enabled = registers.bit(self.base + CCER, 4 * channel)
            && registers.bit(self.base + BDTR, MOE)
            && registers.bit(self.base + CR1, 0)
            && !self.stopped;
        let mode = registers.field(self.base + CCMR1, 4 + 8 * channel, 3);
        if !enabled || mode != 0b110 {
            return 0.0;
        }
        let period = f64::from(registers.get(self.base + ARR));
        (f64::from(registers.get(self.base + CCR1 + 4 * channel)) / period).min(1.0)
    }

    /// The compare value of a channel, 0 or 1.
    #[must_use]
    pub fn compare(&self, channel: u32, registers: &Registers) -> u32 {
        registers.get(self.base + CCR1 + 4 * channel)
    }

    /// Faults of the timer's configuration for two low-side drivers at 16 kHz and a trigger per millisecond.
    #[must_use]
    pub fn audit(&self, registers: &Registers, timer_hz: f64) -> Vec<String> {
        let mut findings = Vec::new();
        let mut check = |good: bool, what: String| {
            if !good {
                findings.push(what);
            }
        };
        let bit = |offset, bit| registers.bit(self.base + offset, bit);
        let pulse_hz = 0.5e9 / self.half_pulse_ns(registers, timer_hz);
        check(
            (pulse_hz - 16e3).abs() < 16.0,
            format!("pulses at {pulse_hz} Hz"),
        );
        let trigger_ns = self.update_ns(registers, timer_hz);
        check(
            (trigger_ns - 1e6).abs() < 1e3,
            format!("a trigger every {trigger_ns} ns"),
        );
        let mode = registers.field(self.base + CR1, 5, 2);
        check(
            mode == 1,
            format!("counting mode {mode}: the trigger isn't in the middle of a pulse"),
        );
        check(
            registers.field(self.base + CR2, 4, 3) == 0b010,
            "the trigger output isn't the update".into(),
        );
        for channel in 0..2 {
            check(
                bit(CCER, 4 * channel) && !bit(CCER, 4 * channel + 1),
                format!("channel {} is off or inverted", channel + 1),
            );
            check(
                !bit(CCER, 4 * channel + 2),
                format!(
                    "channel {} has a complementary output, which needs a dead time",
                    channel + 1
                ),
            );
        }
        check(
            bit(BDTR, BKE) && bit(BDTR, BKP),
            "a clock failure doesn't cut the outputs".into(),
        );
        check(bit(BDTR, 10), "idle outputs float".into());
        findings
    }
}
