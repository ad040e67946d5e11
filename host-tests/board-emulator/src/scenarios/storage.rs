//! Storing a calibration.

use anyhow::{Context, Result, ensure};
use hitch_ecu::Contact;

use super::rig::{READY_MS, Rig};
use super::setup::Setup;
use crate::ecu_tool;
use crate::{Board, Contents, Snapshot};

/// The parameter that is stored, with two values that nothing else in RAM has. The second one is stricter: the board has
/// no key.
const PARAMETER: (&str, &str) = ("position", "upper_limit");
const FIRST: i32 = 131_317;
const SECOND: i32 = 131_113;
/// Time within which storing ends, ms: two erased sectors of the slower part and a record.
const STORED_MS: usize = 8_000;
/// Time from the first look at the stored calibration until the first milliseconds of work, ms.
const LOADED_MS: f64 = 40.0;

/// Stores a value of the parameter with a tuning tool.
fn store(rig: &mut Rig<'_>, value: i32) -> Result<()> {
    rig.run(READY_MS)?;
    let (group, name) = PARAMETER;
    let word = ecu_tool::word(group, name).context("no such parameter")?;
    ecu_tool::begin_service(&mut rig.bench, &mut rig.board)?;
    ecu_tool::change(&mut rig.bench, &mut rig.board, word, value)?;
    ecu_tool::store(&mut rig.bench, &mut rig.board)?;
    for _ in 0..STORED_MS {
        rig.said.clear();
        rig.tick_with(|_| {})?;
        if ecu_tool::says_stored(&rig.said) {
            return Ok(());
        }
    }
    anyhow::bail!("storing does not end")
}

/// Which of the values the calibration in RAM has.
fn in_use(board: &mut Board) -> Result<Vec<i32>> {
    let ram = board.ram()?;
    let is_used = |value: &i32| ram.contains(&value.cast_unsigned());
    Ok([FIRST, SECOND].into_iter().filter(is_used).collect())
}

/// Stores twice, and reads back after power was off.
pub fn store_and_read_back(setup: &Setup) -> Result<String> {
    let mut rig = Rig::typical(setup)?;
    for value in [FIRST, SECOND] {
        store(&mut rig, value)?;
        rig.board.cycle_power()?;
        rig.run(600)?;
        let found = in_use(&mut rig.board)?;
        ensure!(
            found == [value],
            "{found:?} in use after {value} was stored"
        );
        let panel = rig.bench.operator.panel;
        rig.bench.operator.panel = panel.with(Contact::Service, true);
    }
    rig.finish()?;
    Ok("two calibrations stored by XCP and used after power-up".into())
}

/// Cuts power before, within and after each erasing and programming of a second calibration.
pub fn power_cuts(setup: &Setup) -> Result<String> {
    let mut rig = Rig::typical(setup)?;
    store(&mut rig, FIRST)?;
    rig.board.cycle_power()?;
    let before = rig.board.chip().flash.contents.clone();
    store(&mut rig, SECOND)?;
    rig.finish()?;
    let operations = rig.board.chip().flash.operations.clone();
    let start = before_loading(&mut rig.board)?;
    let (cuts, contents) = before.cut_in(setup.layout.part(), &operations);
    let mut news = 0;
    for (when, state) in cuts {
        let new = loads_new(&mut rig.board, &start, &state)
            .with_context(|| format!("power cut {when}"))?;
        news += usize::from(new);
    }
    ensure!(
        loads_new(&mut rig.board, &start, &contents)?,
        "the new calibration is not in use"
    );
    let violations = rig.board.violations();
    ensure!(
        violations.is_empty(),
        "the image must not do this: {violations:#?}"
    );
    Ok(format!(
        "{} operations, cut before and within each: {} times the old calibration, {news} times the new",
        operations.len(),
        2 * operations.len() - news,
    ))
}

/// The board after power-up, just before it looks at the stored calibration: so far all starts are alike.
fn before_loading(board: &mut Board) -> Result<Snapshot> {
    /// A little earlier than the first look, ms.
    const EARLIER_MS: f64 = 0.05;
    board.cycle_power()?;
    let started_ns = board.chip().now_ns;
    board.run_ms(READY_MS as f64)?;
    let read_ns = board.chip().calibration_read_ns;
    let read_ns = read_ns.context("the stored calibration is never read")?;
    board.cycle_power()?;
    board.run_ms((read_ns - started_ns) * 1e-6 - EARLIER_MS)?;
    ensure!(
        board.chip().calibration_read_ns.is_none(),
        "two starts differ"
    );
    board.snapshot()
}

/// Goes on from power-up with these contents; true if the new calibration is in use, false if the old one is.
fn loads_new(board: &mut Board, start: &Snapshot, contents: &Contents) -> Result<bool> {
    board.restore(start)?;
    board.chip().flash.contents = contents.clone();
    board.run_ms(LOADED_MS)?;
    ensure!(board.resets.is_empty(), "{:?}", board.resets);
    let found = in_use(board)?;
    ensure!(found.len() == 1, "{found:?} in use, {}", board.state());
    ensure!(
        board.chip().pwm.updates > 0,
        "the ECU does not begin its first millisecond"
    );
    ensure!(board.chip().off_since_ns.is_some(), "a coil is driven");
    Ok(found == [SECOND])
}
