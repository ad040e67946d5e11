//! The clock tree: the frequency of each part of the chip for the registers written by the image.

use super::part::{PWR, Part};
use super::registers::Registers;

/// Time until the PLL has locked, ns (data sheets: at most 300 us and 40 us).
const PLL_LOCK_NS: f64 = 200e3;

const CR: u32 = 0x00;
const HSE_ON: u32 = 16;
const HSE_READY: u32 = 17;
const CSS_ON: u32 = 19;
const PLL_ON: u32 = 24;
const PLL_READY: u32 = 25;

/// State of the oscillators.
#[derive(Clone, Debug)]
pub struct Clocks {
    part: Part,
    rcc: u32,
    /// When the crystal oscillates, ns; `None` while it is off.
    crystal_ready_ns: Option<f64>,
    pll_ready_ns: Option<f64>,
    /// Frequency of the crystal, Hz.
    pub crystal_hz: f64,
    /// Frequency of the internal oscillator, Hz.
    internal_hz: f64,
    /// The failure was signalled to the image, and the flag is not yet cleared.
    security_flag: bool,
}

impl Clocks {
    /// After a reset, with a crystal and an internal oscillator of these frequencies.
    #[must_use]
    pub const fn new(part: Part, crystal_hz: f64, internal_hz: f64) -> Self {
        Self {
            part,
            rcc: part.addresses().rcc,
            crystal_ready_ns: None,
            pll_ready_ns: None,
            crystal_hz,
            internal_hz,
            security_flag: false,
        }
    }

    const fn configuration(&self) -> u32 {
        self.rcc + 0x08
    }

    const fn pll_configuration(&self) -> u32 {
        match self.part {
            Part::Stm32f405 => self.rcc + 0x04,
            Part::Stm32g474 => self.rcc + 0x0C,
        }
    }

    /// A read of the control, configuration or interrupt register with the hardware's bits in it.
    #[must_use]
    pub fn read(&self, offset: u32, registers: &Registers, now_ns: f64) -> u32 {
        let stored = registers.get(self.rcc + offset);
        let flag = |ready: Option<f64>, bit: u32| {
            if ready.is_some_and(|at| now_ns >= at) {
                1 << bit
            } else {
                0
            }
        };
        match (self.part, offset) {
            (_, CR) => {
                let hsi_ready = match self.part {
                    Part::Stm32f405 => 0b11,
                    Part::Stm32g474 => 0b101 << 8,
                };
                stored & !(1 << HSE_READY | 1 << PLL_READY)
                    | hsi_ready
                    | flag(self.crystal_ready_ns, HSE_READY)
                    | flag(self.pll_ready_ns, PLL_READY)
            }
            (_, 0x08) => stored & !0b1100 | (stored & 0b11) << 2,
            (Part::Stm32f405, 0x0C) => stored | u32::from(self.security_flag) << 7,
            (Part::Stm32g474, 0x1C) => stored | u32::from(self.security_flag) << 8,
            // The low-speed oscillator is on as soon as it is requested, or the watchdog runs.
            (Part::Stm32f405, 0x74) | (Part::Stm32g474, 0x94) => stored | (stored & 1) << 1,
            _ => stored,
        }
    }

    /// After a write. `crystal_start_ns`: how long the crystal takes, `None` if it never starts.
    pub fn written(&mut self, offset: u32, value: u32, now_ns: f64, crystal_start_ns: Option<f64>) {
        match (self.part, offset) {
            (_, CR) => {
                let on = |bit: u32| value >> bit & 1 == 1;
                self.crystal_ready_ns = match (on(HSE_ON), self.crystal_ready_ns) {
                    (true, None) => crystal_start_ns.map(|time| now_ns + time),
                    (true, ready) => ready,
                    (false, _) => None,
                };
                self.pll_ready_ns = match (on(PLL_ON), self.pll_ready_ns) {
                    (true, None) => Some(now_ns + PLL_LOCK_NS),
                    (true, ready) => ready,
                    (false, _) => None,
                };
            }
            (Part::Stm32f405, 0x0C) if value >> 23 & 1 == 1 => self.security_flag = false,
            (Part::Stm32g474, 0x20) if value >> 8 & 1 == 1 => self.security_flag = false,
            _ => {}
        }
    }

    /// The crystal stops; true if the clock security system raises the non-maskable interrupt.
    pub fn fail_crystal(&mut self, registers: &mut Registers) -> bool {
        if !registers.bit(self.rcc + CR, CSS_ON) {
            return false;
        }
        // The hardware switches to the internal oscillator and stops crystal and PLL.
        let hsi = match self.part {
            Part::Stm32f405 => 0b00,
            Part::Stm32g474 => 0b01,
        };
        registers.modify(self.configuration(), 0b11, hsi);
        registers.modify(self.rcc + CR, 1 << HSE_ON | 1 << PLL_ON | 1 << CSS_ON, 0);
        self.crystal_ready_ns = None;
        self.pll_ready_ns = None;
        self.security_flag = true;
        true
    }

    /// True while the security system's flag is set, and with it the non-maskable interrupt is pending.
    #[must_use]
    pub const fn security_flag(&self) -> bool {
        self.security_flag
    }

    /// Clock of the system, Hz.
    #[must_use]
    pub fn system_hz(&self, registers: &Registers) -> f64 {
        let switch = registers.field(self.configuration(), 0, 2);
        match (self.part, switch) {
            (Part::Stm32f405, 1) | (Part::Stm32g474, 2) => self.crystal_hz,
            (Part::Stm32f405, 2) | (Part::Stm32g474, 3) => self.pll_hz(registers),
            _ => self.internal_hz,
        }
    }

    /// Whether the PLL's source is the crystal.
    #[must_use]
    pub fn pll_uses_crystal(&self, registers: &Registers) -> bool {
        let field = |shift, width| registers.field(self.pll_configuration(), shift, width);
        match self.part {
            Part::Stm32f405 => field(22, 1) == 1,
            Part::Stm32g474 => field(0, 2) == 3,
        }
    }

    fn pll_hz(&self, registers: &Registers) -> f64 {
        let [_, internal_hz] = self.pll_internal_hz(registers);
        let shift = match self.part {
            Part::Stm32f405 => 16,
            Part::Stm32g474 => 25,
        };
        let divider = registers.field(self.pll_configuration(), shift, 2);
        internal_hz / (2.0 * (f64::from(divider) + 1.0))
    }

    /// Frequency of the PLL's input and of its oscillator, Hz.
    #[must_use]
    pub fn pll_internal_hz(&self, registers: &Registers) -> [f64; 2] {
        let field =
            |shift, width| f64::from(registers.field(self.pll_configuration(), shift, width));
        let (divider, factor) = match self.part {
            Part::Stm32f405 => (field(0, 6), field(6, 9)),
            Part::Stm32g474 => (field(4, 4) + 1.0, field(8, 7)),
        };
        let source_hz = if self.pll_uses_crystal(registers) {
            self.crystal_hz
        } else {
            self.internal_hz
        };
        [source_hz / divider, source_hz / divider * factor]
    }

    /// Clock of core and memory, Hz.
    #[must_use]
    pub fn core_hz(&self, registers: &Registers) -> f64 {
        let code = registers.field(self.configuration(), 4, 4);
        let divider = match code {
            0..=7 => 1.0,
            8..=11 => f64::from(2 << (code - 8)),
            _ => f64::from(64 << (code - 12)),
        };
        self.system_hz(registers) / divider
    }

    /// Clocks of the peripherals' buses APB1 and APB2, Hz.
    #[must_use]
    pub fn bus_hz(&self, registers: &Registers) -> [f64; 2] {
        let shifts = match self.part {
            Part::Stm32f405 => [10, 13],
            Part::Stm32g474 => [8, 11],
        };
        shifts.map(|shift| {
            self.core_hz(registers) / divider(registers.field(self.configuration(), shift, 3))
        })
    }

    /// Clocks of the timers on APB1 and APB2, Hz: twice the bus's where that is divided.
    #[must_use]
    pub fn timer_hz(&self, registers: &Registers) -> [f64; 2] {
        let core = self.core_hz(registers);
        self.bus_hz(registers)
            .map(|bus| if bus < core { 2.0 * bus } else { bus })
    }

    /// Wait states that the flash needs at this clock (RM0090, table 10, 2.7 to 3.6 V; RM0440, table 29, boost).
    #[must_use]
    pub fn wait_states_needed(&self, registers: &Registers) -> u32 {
        let step_hz = match self.part {
            Part::Stm32f405 => 30e6,
            // 34 MHz in range 1 with boost.
            Part::Stm32g474 if self.is_boosted(registers) => 34e6,
            Part::Stm32g474 => 30e6,
        };
        ((self.core_hz(registers) / step_hz).ceil() as u32).saturating_sub(1)
    }

    /// Whether the regulator is in boost mode (STM32G474).
    #[must_use]
    pub fn is_boosted(&self, registers: &Registers) -> bool {
        !registers.bit(PWR + 0x80, 8)
    }
}

fn divider(code: u32) -> f64 {
    match code {
        0..=3 => 1.0,
        _ => f64::from(2 << (code - 4)),
    }
}
