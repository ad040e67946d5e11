//! A tuning tool on the ECU's bus: the part of XCP that is needed to change and store a value.

use anyhow::{Result, ensure};
use hitch_ecu::Contact;
use hitch_ecu_host::ecu::{Bench, EcuMachine};
use hitch_protocols::can::{ExtendedId, Frame};
use hitch_protocols::xcp::map::CALIBRATION_BASE;
use hitch_quantities::calibration::calibration_words::{GROUPS, SCALARS_WORD};

/// Milliseconds after which an ECU has its address: it waits 250 after its claim.
const CLAIMED_MS: u32 = 300;
/// Milliseconds within which an answer has to come.
const ANSWER_MS: u32 = 100;

/// From the tool to the ECU.
const COMMANDS: u32 = 0x18EF_80F9;
/// And back.
const ANSWERS: u32 = 0x18EF_F980;

/// Number of the word that holds a parameter.
#[must_use]
pub fn word(group: &str, name: &str) -> Option<usize> {
    let names = GROUPS.iter().flat_map(|of| {
        let parameters = of.parameters.iter();
        parameters.map(|parameter| (of.name, parameter.name))
    });
    let index = names.into_iter().position(|found| found == (group, name))?;
    Some(SCALARS_WORD + index)
}

/// Locks the hitch, switches service on and connects.
///
/// # Errors
/// If the ECU doesn't answer as it should.
pub fn begin_service(bench: &mut Bench<'_>, machine: &mut impl EcuMachine) -> Result<()> {
    let panel = bench.operator.panel.with(Contact::FieldMode, false);
    bench.operator.panel = panel.with(Contact::Service, true);
    for _ in 0..CLAIMED_MS {
        bench.tick(machine, &[], &mut Vec::new())?;
    }
    obeyed(bench, machine, &[0xFF, 0])
}

/// Changes a word of the working page.
///
/// # Errors
/// If the ECU refuses.
pub fn change(
    bench: &mut Bench<'_>,
    machine: &mut impl EcuMachine,
    word: usize,
    counts: i32,
) -> Result<()> {
    let [a, b, c, d] = (CALIBRATION_BASE + 4 * word as u32).to_le_bytes();
    obeyed(bench, machine, &[0xF6, 0, 0, 0, a, b, c, d])?;
    let [a, b, c, d] = counts.to_le_bytes();
    obeyed(bench, machine, &[0xF0, 4, a, b, c, d])
}

/// Asks for the working page to be stored; that takes its time.
///
/// # Errors
/// If the ECU refuses.
pub fn store(bench: &mut Bench<'_>, machine: &mut impl EcuMachine) -> Result<()> {
    obeyed(bench, machine, &[0xF9, 0x01, 0, 0])
}

/// Whether these frames report that the working page has been stored.
#[must_use]
pub fn says_stored(said: &[Frame]) -> bool {
    said.iter()
        .filter(|frame| is_answer(frame))
        .any(|frame| frame.data().starts_with(&[0xFD, 0x03]))
}

fn obeyed(bench: &mut Bench<'_>, machine: &mut impl EcuMachine, command: &[u8]) -> Result<()> {
    let id = ExtendedId::new(COMMANDS).unwrap_or(ExtendedId::ZERO);
    let frame = Frame::data_frame(id.into(), command);
    let mut heard: Vec<Frame> = frame.into_iter().collect();
    for _ in 0..ANSWER_MS {
        let mut said = Vec::new();
        bench.tick(machine, &heard, &mut said)?;
        heard.clear();
        if let Some(answer) = said.iter().find(|frame| is_answer(frame)) {
            ensure!(
                answer.data().first() == Some(&0xFF),
                "{command:02X?} is answered with {answer:?}"
            );
            return Ok(());
        }
    }
    anyhow::bail!("{command:02X?} isn't answered")
}

fn is_answer(frame: &Frame) -> bool {
    frame
        .extended_data_id()
        .is_some_and(|id| id.as_raw() == ANSWERS)
}
