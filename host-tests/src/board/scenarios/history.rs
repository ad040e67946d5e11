//! The fault history in flash.

use anyhow::{Context, Result, ensure};
use hitch_firmware::ecu::{AdcCode, Contacts};
use hitch_firmware::j1939::{Id, Pgn, Trouble};
use hitch_model::Model;

use super::Setup;
use super::rig::Rig;
use crate::board::{Contents, Extent, Operation};

/// Time after which the ECU has its address, ms.
const CLAIMED_MS: usize = 600;
/// Time within which it answers, ms.
const ANSWER_MS: usize = 50;
/// Time within which an entry is stored at rest, ms.
const STORED_MS: usize = 5;
/// The address of the tool that asks.
const TOOL: u8 = 0xF9;
/// Address of the ECU.
const ECU: u8 = 0x80;

/// What DM2 says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Previous {
    Nothing,
    /// The lever was missing, and how often.
    LeverMissing(u8),
}

fn lever_off(contacts: &mut Contacts) {
    contacts.samples.lever = AdcCode::new(0);
}

/// Sends a request; the first eight bytes of its answer, an acknowledgement for DM3.
fn ask(rig: &mut Rig<'_>, group: Pgn, answer: Pgn) -> Result<Vec<u8>> {
    let [a, b, c] = group.to_bytes();
    let request = Id {
        priority: 6,
        pgn: Pgn::REQUEST,
        destination: ECU,
        source: TOOL,
    };
    let mut heard = vec![request.frame([a, b, c, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF])];
    for _ in 0..ANSWER_MS {
        let mut said = Vec::new();
        rig.bench
            .tick_with(&mut rig.board, &heard, &mut said, |_| {})?;
        heard.clear();
        let found = said.iter().find(|frame| {
            let id = frame.extended_data_id().map(Id::unpack);
            id.is_some_and(|id| id.pgn == answer)
        });
        if let Some(frame) = found {
            return Ok(frame.data().to_vec());
        }
    }
    anyhow::bail!("{group:?} is not answered")
}

fn previous(rig: &mut Rig<'_>) -> Result<Previous> {
    let data = ask(rig, Pgn::DM2, Pgn::DM2)?;
    let code = Trouble::LeverMissing.code();
    let [low, high, highest, _] = code.spn.to_le_bytes();
    match data.as_slice() {
        &[_, _, 0, 0, 0, 0, ..] => Ok(Previous::Nothing),
        &[_, _, a, b, c, count, ..] if [a, b, c] == [low, high, highest << 5 | code.fmi] => {
            Ok(Previous::LeverMissing(count))
        }
        other => anyhow::bail!("DM2 is {other:02X?}"),
    }
}

/// Switches power off and on with these contents; what DM2 says then.
fn after_power_up(rig: &mut Rig<'_>, contents: Option<&Contents>) -> Result<Previous> {
    rig.board.cycle_power()?;
    if let Some(contents) = contents {
        rig.board.chip().flash.contents = contents.clone();
    }
    rig.run(CLAIMED_MS)?;
    previous(rig)
}

/// The operations since the last start, all of which have to be entries of the log.
fn entries(rig: &mut Rig<'_>) -> Result<Vec<Operation>> {
    let operations = rig.board.chip().flash.operations.clone();
    let only_programs = operations
        .iter()
        .all(|operation| matches!(operation, Operation::Program { .. }));
    ensure!(only_programs, "{operations:?}");
    Ok(operations)
}

/// A fault, restarts, a power cut before and within each operation that stores it, and clearing.
pub fn fault_history(setup: &Setup) -> Result<String> {
    let model = Model::nominal();
    let mut rig = Rig::typical(setup, &model)?;
    rig.run(CLAIMED_MS)?;
    // Erased flash has no calibration, which is a trouble of its own and active at each start.
    ensure!(previous(&mut rig)? == Previous::Nothing, "a new ECU");
    ensure!(
        after_power_up(&mut rig, None)? == Previous::Nothing,
        "a second start"
    );
    let mut contents = rig.board.chip().flash.contents.clone();
    let before = entries(&mut rig)?.len();
    for _ in 0..50 {
        rig.tick_with(lever_off)?;
    }
    let operations = entries(&mut rig)?.split_off(before);
    let stored = after_power_up(&mut rig, None)?;
    ensure!(stored == Previous::LeverMissing(1), "{stored:?}");
    ask(&mut rig, Pgn::DM3, Pgn::ACKNOWLEDGEMENT)?;
    rig.run(STORED_MS)?;
    let cleared = after_power_up(&mut rig, None)?;
    ensure!(cleared == Previous::Nothing, "{cleared:?} after DM3");
    for (number, operation) in operations.iter().enumerate() {
        let mut half = contents.clone();
        half.apply(setup.part, operation, Extent::Half);
        for (when, state) in [("before", &contents), ("in", &half)] {
            let found = after_power_up(&mut rig, Some(state))
                .with_context(|| format!("power cut {when} operation {number}"))?;
            ensure!(
                found == Previous::Nothing,
                "{found:?} after a power cut {when} operation {number}"
            );
        }
        contents.apply(setup.part, operation, Extent::Whole);
    }
    let found = after_power_up(&mut rig, Some(&contents))?;
    ensure!(found == Previous::LeverMissing(1), "{found:?} with all");
    rig.finish()?;
    Ok(format!(
        "a fault stored by {} operations, previously active after power-up, and cleared by DM3; cut before and within each: lost",
        operations.len()
    ))
}
