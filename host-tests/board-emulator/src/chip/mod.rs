//! The part around its processor: registers and time.

mod access;
mod reset;

use std::collections::BTreeSet;

use hitch_protocols::can::Frame;

use crate::adc::Converter;
use crate::can::Can;
use crate::clocks::Clocks;
use crate::conditions::Conditions;
use crate::counters::{Counter, SlowClockCapture};
use crate::enable_line::ENABLE;
use crate::flash::{Contents, Flash};
use crate::part::{DBGMCU, Part, Pin, Port, TIM2};
use crate::pwm::Pwm;
use crate::registers::Registers;
use crate::watchdog::Watchdog;

/// Clocks that an instruction takes: a mean over code that waits for flash now and then.
const CLOCKS_PER_INSTRUCTION: f64 = 2.0;
/// Time that a poll of unfinished converters takes: a polling program does nothing else.
const POLLING_NS: f64 = 2e3;
/// `ECCR` of the STM32G474, and its flag of a double error.
const ECCR: u32 = 0x18;
const ECCD: u32 = 31;

/// Why the processor has stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// The requested time is reached.
    Time,
    /// The watchdog resets the part.
    Watchdog,
    /// The non-maskable interrupt.
    NonMaskable,
    /// An access to an address where nothing is.
    HardFault,
    /// An exception is left.
    ExceptionReturn,
    /// The image asks for a reset.
    Software,
}

/// The part.
#[derive(Clone, Debug)]
pub struct Chip {
    /// Which one.
    pub part: Part,
    /// Registers as written by the image.
    pub registers: Registers,
    /// Time, ns.
    pub now_ns: f64,
    /// When the processor is to stop, ns.
    pub until_ns: f64,
    /// Surroundings.
    pub conditions: Conditions,
    /// Clock tree.
    pub clocks: Clocks,
    /// Flash.
    pub flash: Flash,
    /// Pulse-width outputs.
    pub pwm: Pwm,
    /// Converters.
    pub converters: [Converter; 3],
    /// CAN controller and bus.
    pub can: Can,
    /// Watchdog.
    pub watchdog: Watchdog,
    /// Violations of the manuals by the image.
    pub violations: BTreeSet<String>,
    /// Instructions since the start.
    pub instructions: u64,
    /// Instructions at the converters' last end of sequence, and the most from there to the pulse widths.
    pub instructions_to_drive: u64,
    sampled_at: Option<u64>,
    /// The page of RAM that has a stuck bit.
    stuck_page: Vec<u8>,
    /// When the calibration was read for the first time since the reset, ns.
    pub calibration_read_ns: Option<f64>,
    /// Since when no coil has been driven, ns; `None` while one is.
    pub off_since_ns: Option<f64>,
    tim2: Counter,
    slow_clock: SlowClockCapture,
    /// The part's number.
    unique_id: [u32; 3],
    stop: Option<Stop>,
    in_exception: bool,
    cycle_ns: f64,
    timer_hz: [f64; 2],
    converter_hz: [f64; 3],
    next_event_ns: f64,
}

impl Chip {
    /// A part that comes out of reset at `now_ns`; `flags` are those of the reset's cause.
    #[must_use]
    pub fn new(
        part: Part,
        contents: Contents,
        conditions: Conditions,
        now_ns: f64,
        flags: u32,
    ) -> Self {
        let mut registers = Registers::default();
        reset::reset_values(part, flags, &mut registers);
        let mut chip = Self {
            part,
            registers,
            now_ns,
            until_ns: now_ns,
            clocks: Clocks::new(part, conditions.crystal_hz, conditions.internal_hz),
            flash: Flash::new(part, contents),
            pwm: Pwm::new(part),
            converters: [0, 1, 2].map(|number| Converter::new(part, number)),
            can: Can::new(part),
            watchdog: Watchdog::new(conditions.slow_clock_hz),
            conditions,
            violations: BTreeSet::new(),
            instructions: 0,
            instructions_to_drive: 0,
            sampled_at: None,
            stuck_page: vec![0; 0x1000],
            calibration_read_ns: None,
            off_since_ns: Some(now_ns),
            tim2: Counter::new(TIM2, u32::MAX),
            slow_clock: SlowClockCapture::new(part),
            unique_id: [0x0042_0031, 0x3431_4711, 0x2036_3851],
            stop: None,
            in_exception: false,
            cycle_ns: 0.0,
            timer_hz: [0.0; 2],
            converter_hz: [0.0; 3],
            next_event_ns: 0.0,
        };
        chip.retime();
        chip
    }

    /// Why it has stopped, once.
    pub fn take_stop(&mut self) -> Option<Stop> {
        self.stop.take()
    }

    /// The processor has entered or left an exception.
    pub fn set_in_exception(&mut self, inside: bool) {
        self.in_exception = inside;
        self.raise_if_pending();
    }

    /// Clocks, for checks.
    #[must_use]
    pub const fn timer_hz(&self) -> [f64; 2] {
        self.timer_hz
    }

    /// Clocks of the converters, Hz.
    #[must_use]
    pub const fn converter_hz(&self) -> [f64; 3] {
        self.converter_hz
    }

    /// The level of a pin that the part drives.
    #[must_use]
    pub fn output(&self, pin: Pin) -> bool {
        let base = self.port(pin.port);
        self.registers.field(base, 2 * pin.number, 2) == 1
            && self.registers.bit(base + 0x14, pin.number)
    }

    /// Mode of a pin: 0 input, 1 output, 2 alternate function, 3 analogue.
    #[must_use]
    pub fn mode(&self, pin: Pin) -> u32 {
        self.registers.field(self.port(pin.port), 2 * pin.number, 2)
    }

    /// The alternate function of a pin.
    #[must_use]
    pub fn function(&self, pin: Pin) -> u32 {
        let base = self.port(pin.port) + 0x20 + 4 * (pin.number / 8);
        self.registers.field(base, 4 * (pin.number % 8), 4)
    }

    /// Share of the time for which a pulse-width output's pin is high.
    #[must_use]
    pub fn duty(&self, channel: u32) -> f64 {
        match self.mode(Pin::new(Port::A, 8 + channel)) {
            2 => self.pwm.duty(channel, &self.registers),
            _ => 0.0,
        }
    }

    /// Notes whether a coil is driven after something has changed at the outputs.
    fn watch_outputs(&mut self) {
        let driven = self.output(ENABLE) && (self.duty(0) > 0.0 || self.duty(1) > 0.0);
        if driven {
            self.off_since_ns = None
        } else {
            self.off_since_ns.get_or_insert(self.now_ns);
        }
    }

    const fn port(&self, port: Port) -> u32 {
        self.part.addresses().gpio + 0x400 * port as u32
    }

    /// Other nodes send these frames, one after the other.
    pub fn send_from_others(&mut self, frames: &[Frame]) {
        self.can.from_others.extend(frames);
        if self.can.next_ns() == f64::INFINITY {
            self.can.advance(&self.registers, self.now_ns);
        }
        self.schedule();
    }

    /// The clock tree has another rate for a reason outside the part.
    pub fn clocks_changed(&mut self) {
        let before = self.timer_hz[1];
        self.retime();
        self.pwm.rescale(before / self.timer_hz[1], self.now_ns);
        self.schedule();
    }

    /// The processor locks up; where that is a break source, hardware cuts the outputs.
    pub fn lock_up(&mut self) {
        /// `SYSCFG_CFGR2` of the STM32G474, and its bit for a lockup of the core.
        const CFGR2: u32 = 0x4001_0018;
        if self.part == Part::Stm32g474 && self.registers.bit(CFGR2, 0) {
            self.pwm.take_break(&mut self.registers);
        }
        self.watch_outputs();
    }

    /// The crystal stops.
    pub fn fail_crystal(&mut self) {
        if self.clocks.fail_crystal(&mut self.registers) {
            self.pwm.take_break(&mut self.registers);
        }
        self.clocks_changed();
        self.raise_if_pending();
        self.watch_outputs();
        self.schedule();
    }

    /// Whether a debugger that halts the processor stops TIM1 and the watchdog.
    #[must_use]
    pub fn debug_stops(&self) -> [bool; 2] {
        let timer = match self.part {
            Part::Stm32f405 => (0x0C, 0),
            Part::Stm32g474 => (0x10, 11),
        };
        [timer, (0x08, 12)].map(|(offset, bit)| self.registers.bit(DBGMCU + offset, bit))
    }

    /// The processor is halted by a debugger, or goes on.
    pub fn halt(&mut self, halted: bool) {
        let [timer, watchdog] = self.debug_stops();
        if timer {
            self.pwm.halt(halted);
        }
        if watchdog {
            self.watchdog.freeze(halted, self.now_ns);
        }
        self.watch_outputs();
        self.schedule();
    }

    /// Lets time pass until then, or until something stops the processor.
    pub fn pass(&mut self, until_ns: f64) {
        while self.next_event_ns <= until_ns && self.stop.is_none() {
            self.now_ns = self.now_ns.max(self.next_event_ns);
            self.process();
            self.schedule();
        }
        if self.stop.is_none() {
            self.now_ns = self.now_ns.max(until_ns);
        }
    }

    /// When something happens next.
    pub fn schedule(&mut self) {
        self.next_event_ns = self
            .until_ns
            .min(self.watchdog.expires_ns())
            .min(self.pwm.next_update_ns)
            .min(self.can.next_ns());
    }

    fn process(&mut self) {
        let now_ns = self.now_ns;
        if self.can.next_ns() <= now_ns {
            self.can.advance(&self.registers, now_ns);
        }
        if self.pwm.next_update_ns <= now_ns && self.pwm.update(&self.registers, self.timer_hz[1]) {
            self.trigger_converters();
        }
        if self.watchdog.expires_ns() <= now_ns {
            self.stop = Some(Stop::Watchdog);
        } else if self.until_ns <= now_ns {
            self.stop = Some(Stop::Time);
        }
    }

    fn trigger_converters(&mut self) {
        let share = share_of_reference(self.part, &self.conditions);
        for (converter, clock_hz) in self.converters.iter_mut().zip(self.converter_hz) {
            converter.trigger(&self.registers, clock_hz, self.now_ns, &share);
        }
    }

    /// Starts a regular conversion of a converter, if one is demanded.
    fn convert_regular(&mut self, index: usize) {
        let share = share_of_reference(self.part, &self.conditions);
        let clock_hz = self.converter_hz[index];
        let converter = &mut self.converters[index];
        converter.start_regular(&self.registers, clock_hz, self.now_ns, share);
    }

    /// Works out the clocks after something has been written that they depend on.
    fn retime(&mut self) {
        let registers = &self.registers;
        self.cycle_ns = 1e9 / self.clocks.core_hz(registers);
        self.timer_hz = self.clocks.timer_hz(registers);
        let (core_hz, bus_hz) = (
            self.clocks.core_hz(registers),
            self.clocks.bus_hz(registers),
        );
        self.converter_hz = [0, 1, 2].map(|index| {
            let converter: &Converter = &self.converters[index];
            converter.clock_hz(registers, core_hz, bus_hz)
        });
        self.tim2.settle(registers, self.timer_hz[0], self.now_ns);
        let slow_timer_hz = match self.part {
            Part::Stm32f405 => self.timer_hz[0],
            Part::Stm32g474 => self.timer_hz[1],
        };
        self.slow_clock
            .counter
            .settle(registers, slow_timer_hz, self.now_ns);
    }

    /// Whether the flash is fast enough for the clock.
    fn check_flash_speed(&mut self) {
        let needed = self.clocks.wait_states_needed(&self.registers);
        let set = self.registers.field(self.part.addresses().flash, 0, 4);
        if set < needed {
            let hz = self.clocks.core_hz(&self.registers);
            self.violations.insert(format!(
                "{set} wait states at {hz} Hz, where {needed} are needed"
            ));
        }
    }

    fn raise_if_pending(&mut self) {
        let eccr = self.part.addresses().flash + ECCR;
        let damaged = self.part == Part::Stm32g474 && self.registers.bit(eccr, ECCD);
        if (self.clocks.security_flag() || damaged) && !self.in_exception && self.stop.is_none() {
            self.stop = Some(Stop::NonMaskable);
        }
    }
}

/// The voltage of a converter's channel as a share of the reference.
fn share_of_reference(part: Part, conditions: &Conditions) -> impl Fn(usize, u32) -> f64 {
    move |converter, channel| {
        let volts = match part.analog_pin(converter, channel) {
            Some(pin) => conditions.volts.get(&pin).copied().unwrap_or(0.0),
            None if part.is_internal_reference(converter, channel) => {
                conditions.internal_reference_v
            }
            None => 0.0,
        };
        volts / conditions.reference_v
    }
}
