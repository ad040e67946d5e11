//! Storing a calibration.

use anyhow::{Context, Result, ensure};
use hitch_firmware::ecu::Contact;
use hitch_model::Model;

use super::Setup;
use super::rig::Rig;
use crate::board::{Board, Contents, Extent};
use crate::ecu_tool;

/// The parameter that is stored, with two values that nothing else in RAM has.
const PARAMETER: (&str, &str) = ("position", "upper_limit");
const FIRST: i32 = 131_113;
const SECOND: i32 = 131_317;
/// Time within which storing ends, ms: two erased sectors of the slower part and a record.
const STORED_MS: usize = 8_000;
/// Time from power-up until the calibration in use is in RAM, ms.
const LOADED_MS: f64 = 90.0;

/// Stores a value of the parameter with a tuning tool.
fn store(rig: &mut Rig<'_>, value: i32) -> Result<()> {
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
    let model = Model::nominal();
    let mut rig = Rig::typical(setup, &model)?;
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
    let model = Model::nominal();
    let mut rig = Rig::typical(setup, &model)?;
    store(&mut rig, FIRST)?;
    rig.board.cycle_power()?;
    let before = rig.board.chip().flash.contents.clone();
    store(&mut rig, SECOND)?;
    rig.finish()?;
    let operations = rig.board.chip().flash.operations.clone();
    let mut states: Vec<(String, Contents)> = Vec::new();
    let mut contents = before;
    let mut news = 0;
    for (number, operation) in operations.iter().enumerate() {
        let mut half = contents.clone();
        half.apply(setup.part, operation, Extent::Half);
        states.push((format!("in operation {number}"), half));
        states.push((format!("before operation {number}"), contents.clone()));
        contents.apply(setup.part, operation, Extent::Whole);
        // Sectors are large: not all states are kept at once.
        news += judge(&mut rig.board, &mut states)?;
    }
    states.push(("after the last operation".into(), contents));
    news += judge(&mut rig.board, &mut states)?;
    ensure!(news > 0, "the new calibration is never in use");
    let violations = rig.board.violations();
    ensure!(
        violations.is_empty(),
        "the image must not do this: {violations:#?}"
    );
    Ok(format!(
        "{} operations, cut before and within each: {} times the old calibration, {news} times the new",
        operations.len(),
        2 * operations.len() + 1 - news,
    ))
}

/// Powers up with each of the states; how many times the new calibration is in use.
fn judge(board: &mut Board, states: &mut Vec<(String, Contents)>) -> Result<usize> {
    let mut news = 0;
    for (when, contents) in states.drain(..) {
        board.power_up_with(contents)?;
        board.run_ms(LOADED_MS)?;
        ensure!(
            board.resets.is_empty(),
            "power cut {when}: {:?}",
            board.resets
        );
        let found = in_use(board)?;
        ensure!(
            found.len() == 1,
            "power cut {when}: {found:?} in use, {}",
            board.state()
        );
        news += usize::from(found == [SECOND]);
        ensure!(
            board.chip().pwm.updates > 0,
            "power cut {when}: the ECU does not begin its first millisecond"
        );
        ensure!(
            board.chip().off_since_ns.is_some(),
            "power cut {when}: a coil is driven"
        );
    }
    Ok(news)
}
