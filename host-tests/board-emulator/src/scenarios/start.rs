//! Power-up.

use anyhow::{Context as _, Result, ensure};

use super::rig::{READY_MS, Rig};
use super::setup::Setup;
use crate::{Conditions, Operation, Stop};

/// Frames of the address claim and the status show that the application runs.
fn starts(setup: &Setup, conditions: Conditions) -> Result<f64> {
    let mut rig = Rig::erased(setup, conditions)?;
    let mut ready_ms = None;
    for millisecond in 0..READY_MS + 300 {
        rig.tick_with(|_| {})?;
        ensure!(
            !rig.is_driven(),
            "a coil is driven {millisecond} ms after power-up"
        );
        if rig.board.chip().pwm.updates > 0 {
            ready_ms.get_or_insert(millisecond);
        }
    }
    rig.finish()?;
    ensure!(!rig.said.is_empty(), "the ECU sends nothing");
    ready_ms
        .map(|milliseconds| milliseconds as f64)
        .ok_or_else(|| anyhow::anyhow!("the ECU never begins its first millisecond"))
}

/// A part as it is delivered by the programmer, in typical conditions.
pub fn boot(setup: &Setup) -> Result<String> {
    let ready_ms = starts(setup, Conditions::typical(setup.layout))?;
    Ok(format!(
        "the first millisecond begins {ready_ms} ms after power-up"
    ))
}

/// A part with the manufacturer's option bytes and nothing in flash but the image.
pub fn factory_fresh(setup: &Setup) -> Result<String> {
    let mut rig = Rig::typical(setup)?;
    let before = rig.board.chip().flash.options;
    rig.run(READY_MS + 300)?;
    rig.finish()?;
    let chip = rig.board.chip();
    ensure!(
        chip.flash.options == before,
        "the application changes option bytes"
    );
    // That there is no calibration is a fault, which the log keeps.
    let log_bytes = setup.layout.part().log_bytes();
    let is_entry = |operation: &Operation| matches!(operation, Operation::Program { offset, .. } if *offset < log_bytes);
    ensure!(
        chip.flash.operations.iter().all(is_entry),
        "more than the log of faults is changed before anybody asks for it: {:?}",
        chip.flash.operations
    );
    Ok("no option byte is changed, nothing is erased, only the log of faults is programmed, no reset".into())
}

/// A crystal that takes 100 ms, with the fastest oscillator of the watchdog.
pub fn slow_crystal(setup: &Setup) -> Result<String> {
    let ready_ms = starts(
        setup,
        Conditions {
            crystal_start_ns: Some(100e6),
            slow_clock_hz: 47e3,
            ..Conditions::typical(setup.layout)
        },
    )?;
    Ok(format!(
        "the first millisecond begins {ready_ms} ms after power-up"
    ))
}

/// A crystal that never starts: the watchdog resets the part again and again, and no coil is driven.
pub fn dead_crystal(setup: &Setup) -> Result<String> {
    let conditions = Conditions {
        crystal_start_ns: None,
        ..Conditions::typical(setup.layout)
    };
    let mut rig = Rig::erased(setup, conditions)?;
    rig.stays_off(1_500, |_, _| {})
        .context("without a crystal")?;
    let resets = rig.board.resets.len();
    ensure!(
        resets >= 2
            && rig
                .board
                .resets
                .iter()
                .all(|&reset| reset == Stop::Watchdog),
        "{:?} in 1.5 s",
        rig.board.resets
    );
    Ok(format!("{resets} resets in 1.5 s, no coil driven"))
}

/// The slowest and the fastest oscillator of the watchdog.
pub fn slow_clock_tolerance(setup: &Setup) -> Result<String> {
    let [slowest, fastest] = setup.layout.part().slow_clock_hz();
    for slow_clock_hz in [slowest, 32e3, fastest] {
        starts(
            setup,
            Conditions {
                slow_clock_hz,
                ..Conditions::typical(setup.layout)
            },
        )?;
    }
    Ok(format!("starts at {slowest}, 32000 and {fastest} Hz"))
}
