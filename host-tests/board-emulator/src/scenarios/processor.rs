//! Faults of the processor and its clock.

use anyhow::{Context as _, Result, ensure};

use super::rig::{READY_MS, Rig};
use super::setup::Setup;
use crate::{Board, Conditions, Part};

/// Time within which the watchdog resets a dead program at the slowest oscillator, and the pins are low, ms.
const WATCHDOG_MS: f64 = 20.0;

/// A hitch that is lifted at full speed, in typical conditions.
fn lifted(setup: &Setup) -> Result<Rig<'_>> {
    Rig::lifted(setup, Conditions::typical(setup.layout))
}

/// A failure of a hitch that is lifted, at which hardware cuts the outputs; afterwards the watchdog resets the part.
fn cut_by_hardware(setup: &Setup, fail: impl FnOnce(&mut Board)) -> Result<String> {
    /// No program is as fast.
    const HARDWARE_MS: f64 = 0.01;
    let mut rig = lifted(setup)?;
    let fault_ns = rig.now_ns();
    fail(&mut rig.board);
    let took_ms = rig.restarts(fault_ns, HARDWARE_MS)?;
    rig.finish_after_resets()?;
    Ok(format!(
        "pins low after {took_ms:.3} ms, reset, and ready again"
    ))
}

/// The crystal fails.
pub fn crystal_failure(setup: &Setup) -> Result<String> {
    cut_by_hardware(setup, |board| board.chip().fail_crystal())
}

/// A debugger halts the processor in the middle of a move; the watchdog runs on.
pub fn debugger_halt(setup: &Setup) -> Result<String> {
    cut_by_hardware(setup, |board| board.halt(true))
}

/// The converters stop, so the program waits for ever: the watchdog resets the part.
pub fn stuck_program(setup: &Setup) -> Result<String> {
    let mut worst_ms: f64 = 0.0;
    for slow_clock_hz in setup.layout.part().slow_clock_hz() {
        let conditions = Conditions {
            slow_clock_hz,
            ..Conditions::typical(setup.layout)
        };
        let mut rig = Rig::lifted(setup, conditions)?;
        let fault_ns = rig.now_ns();
        rig.board.chip().pwm.next_update_ns = f64::INFINITY;
        let took_ms = rig.restarts(fault_ns, WATCHDOG_MS);
        let took_ms = took_ms.with_context(|| format!("{slow_clock_hz} Hz"))?;
        worst_ms = worst_ms.max(took_ms);
        rig.finish_after_resets()?;
    }
    Ok(format!(
        "pins low after at most {worst_ms:.2} ms, reset, and ready again"
    ))
}

/// The stack runs out of RAM: the write faults, and the coils are off.
pub fn stack_overflow(setup: &Setup) -> Result<String> {
    let mut rig = lifted(setup)?;
    let fault_ns = rig.now_ns();
    rig.board.set_stack_pointer(0x2000_0020);
    let took_ms = rig.restarts(fault_ns, WATCHDOG_MS)?;
    Ok(format!(
        "pins low after {took_ms:.2} ms, reset, and ready again"
    ))
}

/// Bits of the peripherals' set-up flip while the hitch is lifted: the program notices and restarts.
pub fn flipped_registers(setup: &Setup) -> Result<String> {
    let places = setup.layout.part().addresses();
    // Injected sequence, and sampling times of the slow channels.
    let (sequence, times) = match setup.layout.part() {
        Part::Stm32f405 => (0x38, 0x10),
        Part::Stm32g474 => (0x4C, 0x14),
    };
    let registers = [
        ("TIM1_ARR", places.tim1 + 0x2C, 1 << 4),
        ("TIM1_CCMR1", places.tim1 + 0x18, 1 << 4),
        ("TIM1_RCR", places.tim1 + 0x30, 1 << 1),
        ("GPIOA_MODER", places.gpio, 1 << 17),
        ("GPIOB_MODER", places.gpio + 0x400, 1 << 20),
        ("GPIOC_PUPDR", places.gpio + 0x80C, 1 << 16),
        ("ADC1_JSQR", places.adc[0] + sequence, 1 << 9),
        ("ADC2_SMPR", places.adc[1] + times, 1 << 12),
    ];
    let mut worst_ms: f64 = 0.0;
    for (name, address, bit) in registers {
        let mut rig = lifted(setup)?;
        let fault_ns = rig.now_ns();
        let chip = rig.board.chip();
        let flipped = chip.registers.get(address) ^ bit;
        chip.registers.set(address, flipped);
        let took_ms = rig.restarts(fault_ns, WATCHDOG_MS).context(name)?;
        worst_ms = worst_ms.max(took_ms);
        rig.finish_after_resets()?;
    }
    Ok(format!(
        "{} registers: pins low after at most {worst_ms:.2} ms",
        registers.len()
    ))
}

/// A bit of the program flips in flash: it is found within two seconds, and the ECU doesn't come back.
pub fn flipped_code(setup: &Setup) -> Result<String> {
    let mut rig = lifted(setup)?;
    let last = setup
        .image
        .pieces
        .iter()
        .map(|(address, bytes)| address + bytes.len() as u32);
    let last = (last.max().unwrap_or(0) - 64) & !3;
    let word = rig.board.read_word(last)?;
    rig.board.write_word(last, word ^ 1 << 7)?;
    let fault_ns = rig.now_ns();
    let mut found_ms = None;
    for _ in 0..3_000 {
        rig.tick_with(|_| {})?;
        if !rig.board.resets.is_empty() {
            found_ms.get_or_insert((rig.now_ns() - fault_ns) * 1e-6);
        }
        ensure!(
            found_ms.is_none() || !rig.is_driven(),
            "a coil is driven by a damaged program"
        );
    }
    let found_ms = found_ms.ok_or_else(|| anyhow::anyhow!("the damaged program runs on"))?;
    ensure!(found_ms < 2_000.0, "found after {found_ms} ms");
    rig.board.write_word(last, word)?;
    Ok(format!("found after {found_ms:.0} ms"))
}

/// The main clock runs at a rate that is 30 % off, with all timers on it: only the independent oscillator shows it.
pub fn wrong_clock(setup: &Setup) -> Result<String> {
    let mut worst_ms: f64 = 0.0;
    for factor in [0.7, 1.3] {
        let mut rig = lifted(setup)?;
        let fault_ns = rig.now_ns();
        rig.board.chip().clocks.crystal_hz *= factor;
        rig.board.chip().clocks_changed();
        let took_ms = rig.off_after_ms(fault_ns, 100, |_| {})?;
        ensure!(
            took_ms < 60.0,
            "off after {took_ms} ms at {factor} of the clock"
        );
        worst_ms = worst_ms.max(took_ms);
    }
    Ok(format!("pins low after at most {worst_ms:.1} ms"))
}

/// A bit of RAM is stuck at power-up: the program doesn't start.
pub fn damaged_ram(setup: &Setup) -> Result<String> {
    let conditions = Conditions {
        stuck_ram: Some(0x2001_1004),
        ..Conditions::typical(setup.layout)
    };
    let mut rig = Rig::erased(setup, conditions)?;
    rig.stays_off(READY_MS + 400, |_, _| {})?;
    ensure!(
        rig.board.chip().pwm.updates == 0,
        "the ECU starts with damaged RAM"
    );
    Ok("the ECU does not start".into())
}
