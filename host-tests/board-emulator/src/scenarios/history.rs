//! The fault history in flash.

use anyhow::{Context, Result, ensure};
use hitch_ecu::{AdcCode, Contacts};
use hitch_ecu_host::ecu::{CALIBRATION_BYTES, CutFlash, FLASH_BYTES};
use hitch_protocols::j1939::{Id, Pgn, Trouble};
use hitch_protocols::storage::fault_history::MOST_WRITES;
use hitch_protocols::storage::fault_log::{Entry, FaultLog, MOST_SLOTS};

use super::rig::Rig;
use super::setup::Setup;
use crate::{Conditions, Contents, Operation};

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

/// Content of DM2.
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

/// Switches power off and on with these contents; returns DM2 afterwards.
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
    let mut rig = Rig::typical(setup)?;
    rig.run(CLAIMED_MS)?;
    // Erased flash has no calibration, which is a separate trouble, active at each start.
    ensure!(previous(&mut rig)? == Previous::Nothing, "a new ECU");
    ensure!(
        after_power_up(&mut rig, None)? == Previous::Nothing,
        "a second start"
    );
    let contents = rig.board.chip().flash.contents.clone();
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
    let (cuts, contents) = contents.cut_in(setup.layout.part(), &operations);
    for (when, state) in cuts {
        let found =
            after_power_up(&mut rig, Some(&state)).with_context(|| format!("power cut {when}"))?;
        ensure!(
            found == Previous::Nothing,
            "{found:?} after a power cut {when}"
        );
    }
    let found = after_power_up(&mut rig, Some(&contents))?;
    ensure!(found == Previous::LeverMissing(1), "{found:?} with all");
    rig.finish()?;
    Ok(format!(
        "a fault stored by {} operations, previously active after power-up, and cleared by DM3; cut before and within each: lost",
        operations.len()
    ))
}

/// Time within which a start with a compaction is over, ms: the slower part erases for 2 s.
const COMPACTED_MS: usize = 2_600;
/// Bytes of a page that slots take.
const PAGE_BYTES: usize = 8 * MOST_SLOTS;

/// The log's pages as the ECU's flash on this machine has them.
fn log_in(setup: &Setup, contents: &Contents) -> FaultLog<CutFlash> {
    let mut bytes = vec![0xFF; FLASH_BYTES];
    for page in [0, 1] {
        let from = page * setup.layout.part().erase_bytes() as usize;
        let to = CALIBRATION_BYTES + page * PAGE_BYTES;
        bytes[to..to + PAGE_BYTES].copy_from_slice(&contents.bytes[from..from + PAGE_BYTES]);
    }
    FaultLog::open(CutFlash::holding(bytes).regions().fault_log)
}

/// Flash whose log has an entry of each of these troubles, again and again until it is to be compacted.
fn nearly_full(setup: &Setup, troubles: &[Trouble]) -> Result<Contents> {
    let flash = CutFlash::blank();
    let mut log = FaultLog::open(flash.regions().fault_log);
    for &trouble in troubles.iter().cycle() {
        let code = trouble.code();
        let appended = log.append(Entry { code, count: 1 });
        ensure!(appended.is_ok(), "{appended:?}");
        if log.room() < MOST_WRITES {
            break;
        }
    }
    let mut contents = Contents::erased(setup.layout.part());
    let page = &flash.bytes()[CALIBRATION_BYTES..CALIBRATION_BYTES + PAGE_BYTES];
    contents.bytes[..PAGE_BYTES].copy_from_slice(page);
    Ok(contents)
}

/// Powers up with these contents until the log is compacted; each of the troubles has to be there once.
fn compacts(setup: &Setup, rig: &mut Rig<'_>, contents: &Contents, all: &[Trouble]) -> Result<()> {
    rig.board.cycle_power()?;
    rig.board.chip().flash.contents = contents.clone();
    rig.run(COMPACTED_MS)?;
    ensure!(rig.board.resets.is_empty(), "{:?}", rig.board.resets);
    let mut log = log_in(setup, &rig.board.chip().flash.contents);
    let entries: Vec<Entry> = log.entries().collect();
    for trouble in all {
        let found = entries.iter().filter(|entry| entry.code == trouble.code());
        let count = found.clone().count();
        // That there is no calibration is counted on at each start.
        let expected = 1 + usize::from(*trouble == Trouble::CalibrationLost);
        ensure!(
            count == expected,
            "{trouble:?} {count} times in {entries:?}"
        );
    }
    ensure!(
        rig.board.chip().pwm.updates > 0,
        "the ECU does not begin its first millisecond"
    );
    ensure!(rig.board.chip().off_since_ns.is_some(), "a coil is driven");
    Ok(())
}

/// Starts with a log that is to be compacted, with all codes and the fastest oscillator of the watchdog; and with a few, cut
/// before and within each operation.
pub fn compaction(setup: &Setup) -> Result<String> {
    let [_, fastest_hz] = setup.layout.part().slow_clock_hz();
    let conditions = Conditions {
        slow_clock_hz: fastest_hz,
        ..Conditions::typical(setup.layout)
    };
    let mut rig = Rig::erased(setup, conditions)?;
    compacts(
        setup,
        &mut rig,
        &nearly_full(setup, Trouble::ALL)?,
        Trouble::ALL,
    )?;
    let few = [
        Trouble::LeverMissing,
        Trouble::AngleJumps,
        Trouble::SupplyLow,
    ];
    let contents = nearly_full(setup, &few)?;
    compacts(setup, &mut rig, &contents, &few)?;
    let operations = rig.board.chip().flash.operations.clone();
    let (cuts, _) = contents.cut_in(setup.layout.part(), &operations);
    for (when, state) in cuts.into_iter().skip(1).step_by(2) {
        compacts(setup, &mut rig, &state, &few).with_context(|| format!("power cut {when}"))?;
    }
    rig.finish()?;
    Ok(format!(
        "a log of {} codes compacted at the start without a reset; {} operations for {} codes, cut within each: nothing lost",
        Trouble::ALL.len(),
        operations.len(),
        few.len()
    ))
}
