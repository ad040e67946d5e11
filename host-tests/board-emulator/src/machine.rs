//! The part with its image and its processor, as something that runs the ECU's application.

use std::collections::BTreeSet;
use std::io;
use std::path::Path;

use anyhow::{Context, Result, bail};
use hitch_ecu::link::Reply;
use hitch_ecu::{BoardScaling, Contacts, Panel, Signal};
use hitch_ecu_host::ecu::{EcuMachine, MachineError};
use hitch_protocols::can::Frame;

use super::chip::{Chip, Stop};
use super::conditions::Conditions;
use super::cpu::{Cpu, Register};
use super::enable_line::{ENABLE, ENABLE_READ_BACK};
use super::flash::Contents;
use super::image::Image;
use super::layout::Layout;
use super::part::{FLASH, RAM, RAM_BYTES};

/// A millisecond, ns.
const MILLISECOND_NS: f64 = 1e6;
/// Reset flags of `RCC_CSR`, the same on both parts but for their meaning of bit 27: power, pin, watchdog, software.
const POWER_FLAGS: u32 = 1 << 27 | 1 << 26;
const WATCHDOG_FLAGS: u32 = 1 << 29 | 1 << 26;
const SOFTWARE_FLAGS: u32 = 1 << 28 | 1 << 26;
/// Exceptions by their number, which is their place in the vector table.
const NON_MASKABLE: u32 = 2;
const HARD_FAULT: u32 = 3;
/// In a stacked program status: the stack pointer was moved by a word for its alignment.
const STACK_ALIGNED: u32 = 1 << 9;

/// Places of supply and sensor supply in [`Samples::codes`].
const SUPPLY: usize = Signal::Supply as usize;
const SENSOR_SUPPLY: usize = Signal::SensorSupply as usize;

/// Steps of the timer in half a pulse on both boards: 168 MHz, counted up and down at 16 kHz.
const PWM_STEPS: u16 = 5_250;

/// A board at some time.
#[derive(Clone, Debug)]
pub struct Snapshot {
    chip: Chip,
    registers: [u32; Register::ALL.len()],
    pc: u32,
    ram: Vec<u8>,
}

/// The board.
pub struct Board {
    cpu: Cpu<Chip>,
    layout: Layout,
    image: Image,
    pc: u32,
    /// The processor is halted by a debugger, or locked up.
    halted: bool,
    /// Resets since the board was made, power-up left out.
    pub resets: Vec<Stop>,
    /// Violations of the times before the last reset.
    past_violations: BTreeSet<String>,
}

impl Board {
    /// A board with this image, `contents` of flash and conditions, that is powered up.
    ///
    /// # Errors
    /// If the processor can't be emulated.
    pub fn new(
        library: &Path,
        layout: Layout,
        image: &Image,
        contents: Contents,
        mut conditions: Conditions,
    ) -> Result<Self> {
        conditions.wires.push((ENABLE, ENABLE_READ_BACK));
        let part = layout.part();
        let chip = Chip::new(part, contents, conditions, 0.0, POWER_FLAGS);
        let mut cpu = Cpu::new(library, chip)?;
        let (data, _) = part.data();
        cpu.map_memory(FLASH, data - FLASH, false)?;
        match cpu.bus().conditions.stuck_ram.map(|stuck| stuck & !0xFFF) {
            None => cpu.map_memory(RAM, RAM_BYTES, true)?,
            Some(page) => {
                cpu.map_memory(RAM, page - RAM, true)?;
                cpu.map_bus(page, 0x1000)?;
                cpu.map_memory(page + 0x1000, RAM + RAM_BYTES - page - 0x1000, true)?;
            }
        }
        cpu.map_bus(data & !0xFFF, part.data().1)?;
        for (address, bytes) in [
            (0x1FFF_7000, 0x1000),
            (0x4000_0000, 0x3_0000),
            (0x4800_0000, 0x2000),
            (0x5000_0000, 0x1000),
            (0xE000_0000, 0x10_0000),
        ] {
            cpu.map_bus(address, bytes)?;
        }
        let mut board = Self {
            cpu,
            layout,
            image: image.clone(),
            pc: 0,
            halted: false,
            resets: Vec::new(),
            past_violations: BTreeSet::new(),
        };
        board.program()?;
        board.fill_ram()?;
        board.start()?;
        Ok(board)
    }

    fn program(&mut self) -> Result<()> {
        let (data, _) = self.cpu.bus().part.data();
        let erased = vec![0xFF; (data - FLASH) as usize];
        self.cpu.write_memory(FLASH, &erased)?;
        for (address, bytes) in &self.image.pieces {
            self.cpu
                .write_memory(*address, bytes)
                .context("the image doesn't fit the flash")?;
        }
        Ok(())
    }

    /// RAM holds anything after power-up.
    fn fill_ram(&mut self) -> Result<()> {
        if self.cpu.bus().conditions.stuck_ram.is_some() {
            return Ok(());
        }
        let mut random = fastrand::Rng::with_seed(405_474);
        let bytes: Vec<u8> = (0..RAM_BYTES).map(|_| random.u8(..)).collect();
        self.cpu.write_memory(RAM, &bytes)
    }

    /// The part.
    pub fn chip(&mut self) -> &mut Chip {
        self.cpu.bus()
    }

    /// Violations of the manuals by the image, before the last reset and since.
    pub fn violations(&mut self) -> BTreeSet<String> {
        let now = self.cpu.bus().violations.iter().cloned();
        let mut all = self.past_violations.clone();
        all.extend(now);
        all
    }

    /// A word of RAM or flash.
    ///
    /// # Errors
    /// If there is no memory.
    pub fn read_word(&mut self, address: u32) -> Result<u32> {
        let mut bytes = [0; 4];
        self.cpu.read_memory(address, &mut bytes)?;
        Ok(u32::from_le_bytes(bytes))
    }

    /// All of RAM, as words.
    ///
    /// # Errors
    /// If there is no memory.
    pub fn ram(&mut self) -> Result<Vec<u32>> {
        let mut bytes = vec![0; RAM_BYTES as usize];
        self.cpu.read_memory(RAM, &mut bytes)?;
        let (words, _) = bytes.as_chunks::<4>();
        Ok(words.iter().map(|word| u32::from_le_bytes(*word)).collect())
    }

    /// Changes a word of memory: a flipped bit.
    ///
    /// # Errors
    /// If there is no memory.
    pub fn write_word(&mut self, address: u32, value: u32) -> Result<()> {
        self.cpu.write_memory(address, &value.to_le_bytes())
    }

    /// Sets the stack pointer.
    pub fn set_stack_pointer(&mut self, address: u32) {
        self.cpu.set_register(Register::Sp, address);
    }

    /// Where the program is, for a message.
    pub fn state(&mut self) -> String {
        let chip = self.cpu.bus();
        let (updates, milliseconds) = (chip.pwm.updates, chip.now_ns * 1e-6);
        format!(
            "at {:#010x} after {milliseconds:.3} ms and {updates} steps",
            self.pc
        )
    }

    fn vector(&mut self, number: u32) -> Result<u32> {
        self.read_word(FLASH + 4 * number)
    }

    /// Takes stack pointer and first instruction from the vector table.
    fn start(&mut self) -> Result<()> {
        let (stack, entry) = (self.vector(0)?, self.vector(1)?);
        self.cpu.set_register(Register::Xpsr, 1 << 24);
        self.cpu.set_register(Register::Sp, stack);
        self.cpu.set_register(Register::Lr, u32::MAX);
        self.pc = entry & !1;
        self.halted = false;
        Ok(())
    }

    /// Comes out of a reset with these flags; flash and surroundings stay.
    fn reset(&mut self, flags: u32) -> Result<()> {
        let chip = self.cpu.bus();
        let past = chip.violations.iter().cloned();
        self.past_violations.extend(past);
        let (contents, conditions) = (chip.flash.contents.clone(), chip.conditions.clone());
        let until_ns = chip.until_ns;
        let options = chip.flash.options;
        let off_since_ns = chip.off_since_ns;
        let mut fresh = Chip::new(chip.part, contents, conditions, chip.now_ns, flags);
        fresh.until_ns = until_ns;
        fresh.flash.options = options;
        // A reset lets go of all outputs.
        fresh.off_since_ns = off_since_ns.or(fresh.off_since_ns);
        fresh.schedule();
        *chip = fresh;
        self.start()
    }

    /// Switches power off and on.
    ///
    /// # Errors
    /// If memory can't be written.
    pub fn cycle_power(&mut self) -> Result<()> {
        self.fill_ram()?;
        self.reset(POWER_FLAGS)
    }

    /// Part, registers and RAM as they are now.
    ///
    /// # Errors
    /// If memory can't be read.
    pub fn snapshot(&mut self) -> Result<Snapshot> {
        let mut ram = vec![0; RAM_BYTES as usize];
        self.cpu.read_memory(RAM, &mut ram)?;
        Ok(Snapshot {
            chip: self.cpu.bus().clone(),
            registers: Register::ALL.map(|register| self.cpu.register(register)),
            pc: self.pc,
            ram,
        })
    }

    /// Goes on from a snapshot.
    ///
    /// # Errors
    /// If memory can't be written.
    pub fn restore(&mut self, snapshot: &Snapshot) -> Result<()> {
        *self.cpu.bus() = snapshot.chip.clone();
        self.cpu.write_memory(RAM, &snapshot.ram)?;
        for (register, value) in Register::ALL.into_iter().zip(snapshot.registers) {
            self.cpu.set_register(register, value);
        }
        self.pc = snapshot.pc;
        self.halted = false;
        Ok(())
    }

    /// A debugger halts the processor, or lets it go on.
    pub fn halt(&mut self, halted: bool) {
        self.halted = halted;
        self.cpu.bus().halt(halted);
    }

    /// Runs until this time, ns.
    ///
    /// # Errors
    /// If the processor meets an unknown instruction or address.
    pub fn run_until(&mut self, until_ns: f64) -> Result<()> {
        let chip = self.cpu.bus();
        chip.until_ns = until_ns;
        chip.schedule();
        loop {
            if self.halted {
                self.cpu.bus().pass(until_ns + 1.0);
            } else {
                self.pc = self.cpu.run(self.pc)?;
            }
            match self.cpu.bus().take_stop() {
                None => bail!("the processor stops for no reason at {:#010x}", self.pc),
                Some(Stop::Time) => return Ok(()),
                Some(stop @ Stop::Watchdog) => {
                    self.resets.push(stop);
                    self.reset(WATCHDOG_FLAGS)?;
                }
                Some(stop @ Stop::Software) => {
                    self.resets.push(stop);
                    self.reset(SOFTWARE_FLAGS)?;
                }
                Some(Stop::NonMaskable) => self.enter(NON_MASKABLE)?,
                Some(Stop::HardFault) => self.enter(HARD_FAULT)?,
                Some(Stop::ExceptionReturn) => self.leave()?,
            }
        }
    }

    /// Runs for some milliseconds.
    ///
    /// # Errors
    /// If the processor meets an unknown instruction or address.
    pub fn run_ms(&mut self, milliseconds: f64) -> Result<()> {
        let until_ns = self.cpu.bus().now_ns + milliseconds * MILLISECOND_NS;
        self.run_until(until_ns)
    }

    /// Takes an exception: eight registers go onto the stack, from a multiple of eight bytes on (ARMv7-M, B1.5.6). Bit 9
    /// of the stacked program status records that a word was left free for this.
    fn enter(&mut self, number: u32) -> Result<()> {
        let sp = self.cpu.register(Register::Sp);
        let frame_at = (sp & !7).wrapping_sub(32);
        if !(RAM..RAM + RAM_BYTES).contains(&frame_at) {
            // A fault while stacking for a fault: the processor locks up, and only the watchdog is left.
            self.halted = true;
            self.cpu.bus().lock_up();
            return Ok(());
        }
        let mut xpsr = self.cpu.register(Register::Xpsr) & !STACK_ALIGNED;
        if !sp.is_multiple_of(8) {
            xpsr |= STACK_ALIGNED;
        }
        let mut frame = Vec::new();
        for register in [
            Register::R0,
            Register::R1,
            Register::R2,
            Register::R3,
            Register::R12,
            Register::Lr,
        ] {
            frame.push(self.cpu.register(register));
        }
        frame.extend([self.pc, xpsr]);
        let bytes: Vec<u8> = frame.iter().flat_map(|word| word.to_le_bytes()).collect();
        self.cpu.write_memory(frame_at, &bytes)?;
        self.cpu.set_register(Register::Sp, frame_at);
        self.cpu.set_register(Register::Lr, 0xFFFF_FFF9);
        self.cpu.set_register(Register::Xpsr, 1 << 24 | number);
        self.pc = self.vector(number)? & !1;
        self.cpu.bus().set_in_exception(true);
        Ok(())
    }

    /// Returns from an exception.
    fn leave(&mut self) -> Result<()> {
        let sp = self.cpu.register(Register::Sp);
        let mut words = [0_u32; 8];
        for (word, at) in words.iter_mut().zip((sp..).step_by(4)) {
            let mut bytes = [0; 4];
            self.cpu.read_memory(at, &mut bytes)?;
            *word = u32::from_le_bytes(bytes);
        }
        let [r0, r1, r2, r3, r12, lr, pc, xpsr] = words;
        let free = if xpsr & STACK_ALIGNED == 0 { 0 } else { 4 };
        for (register, value) in [
            (Register::Xpsr, xpsr & !STACK_ALIGNED),
            (Register::R0, r0),
            (Register::R1, r1),
            (Register::R2, r2),
            (Register::R3, r3),
            (Register::R12, r12),
            (Register::Lr, lr),
            (Register::Sp, sp + 32 + free),
        ] {
            self.cpu.set_register(register, value);
        }
        self.pc = pc & !1;
        self.cpu.bus().set_in_exception(false);
        Ok(())
    }

    fn connect(&mut self, contacts: &Contacts) {
        let chip = self.cpu.bus();
        let nominal = BoardScaling::NOMINAL;
        let [supply, sensor_supply] = self.layout.supply_scales();
        let pins = self.layout.sample_pins();
        for ((pin, code), place) in pins.into_iter().zip(contacts.samples.codes()).zip(0..) {
            // The codes are those of the nominal board, with a reference of 3.3 V.
            let full_scale_v = match place {
                SUPPLY => 3.3 * f64::from(nominal.supply.0) / f64::from(supply.0),
                SENSOR_SUPPLY => {
                    3.3 * f64::from(nominal.sensor_supply.0) / f64::from(sensor_supply.0)
                }
                _ => 3.3,
            };
            let volts = f64::from(code.get()) / 4096.0 * full_scale_v;
            match pin {
                Some(pin) => {
                    chip.conditions.volts.insert(pin, volts);
                }
                None => chip.conditions.internal_reference_v = volts,
            }
        }
        // A closed contact is low.
        for (contact, pin) in Panel::CONTACTS.into_iter().zip(Layout::contact_pins()) {
            let closed = contacts.panel.is_closed(contact);
            chip.conditions.levels.insert(pin, !closed);
        }
    }

    /// Levels of the board's outputs.
    pub fn drive(&mut self) -> Reply {
        let steps = f64::from(PWM_STEPS);
        let chip = self.cpu.bus();
        let compare = |channel| (chip.duty(channel) * steps).round() as u16;
        Reply {
            lift: compare(0),
            lower: compare(1),
            enable: chip.output(ENABLE),
            kicked: true,
            ..Reply::default()
        }
    }
}

impl EcuMachine for Board {
    fn tick(
        &mut self,
        contacts: &Contacts,
        heard: &[Frame],
        said: &mut Vec<Frame>,
    ) -> Result<Reply, MachineError> {
        self.connect(contacts);
        self.cpu.bus().send_from_others(heard);
        let ran = self.run_ms(1.0);
        ran.map_err(|error| MachineError::Ended(format!("{error:#}")))?;
        said.append(&mut self.cpu.bus().can.sent);
        Ok(self.drive())
    }

    fn power_cycle(&mut self) -> Result<(), MachineError> {
        self.cycle_power()
            .map_err(|error| MachineError::Link(io::Error::other(format!("{error:#}"))))
    }
}
