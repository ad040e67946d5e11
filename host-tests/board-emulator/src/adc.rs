//! The converters' injected sequences, and their regular conversions.

use super::part::{Part, Pin};
use super::registers::Registers;
use super::regular::Regular;

/// One converter.
#[derive(Clone, Debug)]
pub struct Converter {
    part: Part,
    number: usize,
    base: u32,
    common: u32,
    /// The sequence that runs ends then, ns; its codes come into the data registers.
    done_ns: Option<f64>,
    codes: [u32; 4],
    /// The end of the sequence has not been cleared.
    finished: bool,
    calibrated_ns: f64,
    /// Regular conversions.
    pub regular: Regular,
    /// A trigger came while a sequence was still running.
    pub overran: bool,
}

/// Codes of twelve bits.
const CODES: f64 = 4096.0;

impl Converter {
    /// ADC1 to ADC3, by 0 to 2, after a reset.
    #[must_use]
    pub const fn new(part: Part, number: usize) -> Self {
        let addresses = part.addresses();
        Self {
            part,
            number,
            base: addresses.adc[number],
            common: addresses.adc_common[if number < 2 { 0 } else { 1 }],
            done_ns: None,
            codes: [0; 4],
            finished: false,
            calibrated_ns: 0.0,
            regular: Regular::new(),
            overran: false,
        }
    }

    /// The channels of the sequence in their order.
    #[must_use]
    pub fn channels(&self, registers: &Registers) -> Vec<u32> {
        match self.part {
            Part::Stm32f405 => {
                let length = registers.field(self.base + 0x38, 20, 2) + 1;
                let place = |index| registers.field(self.base + 0x38, 5 * (4 - length + index), 5);
                (0..length).map(place).collect()
            }
            Part::Stm32g474 => {
                let length = registers.field(self.base + 0x4C, 0, 2) + 1;
                let place = |index| registers.field(self.base + 0x4C, 9 + 6 * index, 5);
                (0..length).map(place).collect()
            }
        }
    }

    /// Clock of the converter, Hz.
    #[must_use]
    pub fn clock_hz(&self, registers: &Registers, core_hz: f64, bus_hz: [f64; 2]) -> f64 {
        match self.part {
            // Common CCR at offset 4.
            Part::Stm32f405 => {
                bus_hz[1] / f64::from(2 * (registers.field(self.common + 4, 16, 2) + 1))
            }
            Part::Stm32g474 => match registers.field(self.common + 8, 16, 2) {
                0 => f64::NAN,
                mode => core_hz / f64::from(1 << (mode - 1)),
            },
        }
    }

    fn sample_cycles(&self, channel: u32, registers: &Registers) -> f64 {
        match self.part {
            Part::Stm32f405 => {
                let code = match channel.checked_sub(10) {
                    Some(high) => registers.field(self.base + 0x0C, 3 * high, 3),
                    None => registers.field(self.base + 0x10, 3 * channel, 3),
                };
                [3.0, 15.0, 28.0, 56.0, 84.0, 112.0, 144.0, 480.0][code as usize]
            }
            Part::Stm32g474 => {
                let code = match channel.checked_sub(10) {
                    Some(high) => registers.field(self.base + 0x18, 3 * high, 3),
                    None => registers.field(self.base + 0x14, 3 * channel, 3),
                };
                [2.5, 6.5, 12.5, 24.5, 47.5, 92.5, 247.5, 640.5][code as usize]
            }
        }
    }

    /// How long a sequence takes, ns.
    #[must_use]
    pub fn sequence_ns(&self, registers: &Registers, clock_hz: f64) -> f64 {
        let channels = self.channels(registers);
        channels
            .iter()
            .map(|&channel| self.conversion_ns(channel, registers, clock_hz))
            .sum()
    }

    fn conversion_ns(&self, channel: u32, registers: &Registers, clock_hz: f64) -> f64 {
        let overhead = match self.part {
            Part::Stm32f405 => 12.0,
            Part::Stm32g474 => 12.5,
        };
        (self.sample_cycles(channel, registers) + overhead) / clock_hz * 1e9
    }

    /// Starts a regular conversion if the last write demands one; `share` gives a channel's share of the reference.
    pub fn start_regular(
        &mut self,
        registers: &Registers,
        clock_hz: f64,
        now_ns: f64,
        share: impl Fn(usize, u32) -> f64,
    ) {
        if !self.regular.take_demand() {
            return;
        }
        let channel = self.regular_channel(registers);
        let exact = share(self.number, channel) * CODES;
        let code = exact.round().clamp(0.0, CODES - 1.0) as u32;
        // A sequence that runs has priority.
        let from_ns = self.done_ns.unwrap_or(now_ns).max(now_ns);
        let duration_ns = self.conversion_ns(channel, registers, clock_hz);
        self.regular.start(channel, code, from_ns, duration_ns);
    }

    /// The first channel of the regular sequence.
    fn regular_channel(&self, registers: &Registers) -> u32 {
        match self.part {
            Part::Stm32f405 => registers.field(self.base + 0x34, 0, 5),
            Part::Stm32g474 => registers.field(self.base + 0x30, 6, 5),
        }
    }

    /// Number of further channels in the regular sequence.
    fn regular_length(&self, registers: &Registers) -> u32 {
        match self.part {
            Part::Stm32f405 => registers.field(self.base + 0x2C, 20, 4),
            Part::Stm32g474 => registers.field(self.base + 0x30, 0, 4),
        }
    }

    /// Whether TIM1's trigger starts the sequence.
    fn is_armed(&self, registers: &Registers) -> bool {
        match self.part {
            // On, triggered by TIM1's TRGO on rising edges.
            Part::Stm32f405 => {
                registers.bit(self.base + 8, 0)
                    && registers.field(self.base + 8, 16, 4) == 1
                    && registers.field(self.base + 8, 20, 2) == 1
                    && registers.bit(self.base + 4, 8)
            }
            Part::Stm32g474 => {
                registers.bit(self.base + 8, 0)
                    && registers.bit(self.base + 8, 3)
                    && registers.field(self.base + 0x4C, 2, 5) == 0
                    && registers.field(self.base + 0x4C, 7, 2) == 1
            }
        }
    }

    /// TIM1 triggers; `volts` gives a channel's share of the reference.
    pub fn trigger(
        &mut self,
        registers: &Registers,
        clock_hz: f64,
        now_ns: f64,
        share: impl Fn(usize, u32) -> f64,
    ) {
        if !self.is_armed(registers) {
            return;
        }
        self.settle(now_ns);
        if self.done_ns.is_some() {
            self.overran = true;
            return;
        }
        let done_ns = now_ns + self.sequence_ns(registers, clock_hz);
        self.done_ns = Some(done_ns);
        self.regular.interrupt(done_ns);
        let channels = self.channels(registers);
        for (code, channel) in self.codes.iter_mut().zip(channels) {
            let exact = share(self.number, channel) * CODES;
            *code = exact.round().clamp(0.0, CODES - 1.0) as u32;
        }
    }

    fn settle(&mut self, now_ns: f64) {
        if self.done_ns.is_some_and(|done| now_ns >= done) {
            self.done_ns = None;
            self.finished = true;
        }
        self.regular.settle(now_ns);
    }

    /// Whether the end of the sequence has not been reached.
    #[must_use]
    pub fn is_waiting(&self) -> bool {
        !self.finished
    }

    /// A read at `offset`.
    pub fn read(&mut self, offset: u32, registers: &Registers, now_ns: f64) -> u32 {
        self.settle(now_ns);
        let stored = registers.get(self.base + offset);
        match (self.part, offset) {
            (Part::Stm32f405, 0x00) => {
                u32::from(self.finished) << 2 | u32::from(self.regular.has_ended()) << 1
            }
            (Part::Stm32f405, 0x4C) | (Part::Stm32g474, 0x40) => self.regular.take_code(),
            (Part::Stm32f405, 0x3C..=0x48) => self.codes[(offset as usize - 0x3C) / 4],
            (Part::Stm32g474, 0x00) => {
                let ready = u32::from(registers.bit(self.base + 8, 0));
                let ended = u32::from(self.regular.has_ended());
                ready | ended << 2 | u32::from(self.finished) << 6
            }
            (Part::Stm32g474, 0x08) => {
                let calibrates = now_ns < self.calibrated_ns;
                let running = u32::from(self.regular.is_running());
                stored & !(1 << 31) | u32::from(calibrates) << 31 | running << 2
            }
            (Part::Stm32g474, 0x80..=0x8C) => self.codes[(offset as usize - 0x80) / 4],
            _ => stored,
        }
    }

    /// After a write at `offset` to a register that held `before`; returns its fault, if any.
    pub fn written(
        &mut self,
        offset: u32,
        (before, value): (u32, u32),
        registers: &mut Registers,
        now_ns: f64,
    ) -> Option<String> {
        self.settle(now_ns);
        match (self.part, offset) {
            // Writing zero clears on the one part, writing one on the other.
            (Part::Stm32f405, 0x00) => {
                self.finished &= value >> 2 & 1 == 1;
                self.regular.keep_end(value >> 1 & 1 == 1);
            }
            (Part::Stm32f405, 0x08) if value >> 30 & 1 == 1 => {
                // Hardware clears the bit when the conversion starts.
                registers.set(self.base + 8, value & !(1 << 30));
                self.regular.demand();
                if value & 1 == 0 {
                    return Some(self.fault("converts while it is off"));
                }
            }
            // A sequence that changes is begun anew.
            (Part::Stm32f405, 0x2C..=0x34) => self.regular.begin_anew(),
            (Part::Stm32g474, 0x00) => {
                self.finished &= value >> 6 & 1 == 0;
                self.regular.keep_end(value >> 2 & 1 == 0);
            }
            (Part::Stm32g474, 0x30) if self.regular.is_running() => {
                return Some(self.fault("gets another sequence while it converts"));
            }
            (Part::Stm32g474, 0x08) => return self.controlled(before, value, registers, now_ns),
            _ => {}
        }
        None
    }

    /// After a write to the control register of the STM32G474.
    fn controlled(
        &mut self,
        before: u32,
        value: u32,
        registers: &mut Registers,
        now_ns: f64,
    ) -> Option<String> {
        /// Enable and start bits: writing zero leaves them.
        const KEPT: u32 = 0b1001;
        /// Start of regular conversions.
        const START: u32 = 1 << 2;
        let kept = before & KEPT;
        registers.set(self.base + 8, (value | kept) & !START);
        if value >> 31 == 1 {
            self.calibrated_ns = now_ns + 116.0 / 42e6 * 1e9;
            if value >> 28 & 1 == 0 || (value | kept) & 1 == 1 {
                return Some(self.fault("is calibrated while it is on"));
            }
        }
        if value & 1 == 1 && now_ns < self.calibrated_ns {
            return Some(self.fault("is enabled while it is calibrated"));
        }
        if value & START != 0 && !self.regular.is_running() {
            self.regular.demand();
            if (value | kept) & 1 == 0 {
                return Some(self.fault("converts while it is off"));
            }
        }
        None
    }

    fn fault(&self, what: &str) -> String {
        format!("ADC{} {what}", self.number + 1)
    }

    /// Faults of its initialisation.
    #[must_use]
    pub fn audit(
        &self,
        registers: &Registers,
        clock_hz: f64,
        is_analog: impl Fn(Pin) -> bool,
    ) -> Vec<String> {
        let name = format!("ADC{}", self.number + 1);
        let mut findings = Vec::new();
        let most_hz = match self.part {
            Part::Stm32f405 => 36e6,
            Part::Stm32g474 => 60e6,
        };
        if !(clock_hz > 0.6e6 && clock_hz <= most_hz) {
            findings.push(format!("{name} is clocked with {clock_hz} Hz"));
        }
        if !self.is_armed(registers) {
            findings.push(format!("{name} isn't started by TIM1"));
        }
        let further = self.regular_length(registers);
        if further != 0 {
            findings.push(format!(
                "a regular sequence of {name} has {} channels",
                further + 1
            ));
        }
        let injected = self.channels(registers);
        for &channel in injected.iter().chain(&self.regular.channels) {
            match self.part.analog_pin(self.number, channel) {
                Some(pin) if !is_analog(pin) => {
                    findings.push(format!("{pin}, a channel of {name}, isn't analogue"));
                }
                None if !self.part.is_internal_reference(self.number, channel) => {
                    findings.push(format!("channel {channel} of {name} has no pin"));
                }
                _ => {}
            }
            // 10 kOhm of sensor and filter charge the sampling capacitor (data sheets) in a microsecond.
            let sampled_ns = self.sample_cycles(channel, registers) / clock_hz * 1e9;
            if sampled_ns < 1e3 {
                findings.push(format!(
                    "channel {channel} of {name} is sampled for {sampled_ns} ns"
                ));
            }
            let reference_ns = match self.part {
                Part::Stm32f405 => 10e3,
                Part::Stm32g474 => 4e3,
            };
            if self.part.is_internal_reference(self.number, channel) && sampled_ns < reference_ns {
                findings.push(format!("the reference is sampled for {sampled_ns} ns"));
            }
        }
        if self.overran {
            findings.push(format!("{name} is triggered while its sequence runs"));
        }
        findings
    }
}
