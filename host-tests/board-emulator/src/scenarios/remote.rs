//! Remote control by an implement.

use anyhow::{Context as _, Result, ensure};
use hitch_ecu::Contact;
use hitch_ecu_host::ecu::Order;
use hitch_protocols::can::Frame;
use hitch_protocols::j1939::hitch::StatusMessage;
use hitch_protocols::j1939::{ExitCode, GLOBAL, HitchCommand, Id, Name, NameFields, Pgn};

use super::rig::Rig;
use super::setup::Setup;

/// Address of the implement.
const SOURCE: u8 = 0x26;
/// Period of its commands, ms.
const PERIOD_MS: usize = 100;
/// The position that it asks for, raw, and its angle by the factory calibration, degree.
const ASKED: u8 = 200;
const ASKED_DEG: f64 = 44.6 + 0.8 * 90.8;

fn message(pgn: Pgn, bytes: [u8; 8]) -> Frame {
    let id = Id {
        priority: 3,
        pgn,
        destination: GLOBAL,
        source: SOURCE,
    };
    id.frame(bytes)
}

fn status(rig: &Rig<'_>) -> Result<StatusMessage> {
    let found = rig.said.iter().rev().find_map(|frame| {
        let id = frame.extended_data_id().map(Id::unpack)?;
        let bytes = frame.eight().filter(|_| id.pgn == Pgn::REAR_HITCH_STATUS)?;
        Some(StatusMessage::from_bytes(bytes))
    });
    found.context("the ECU sends no status")
}

/// Commands a position, or the reported one. True if a coil was driven.
fn command(rig: &mut Rig<'_>, raw: Option<u8>, milliseconds: usize) -> Result<bool> {
    let mut driven = false;
    for millisecond in 0..milliseconds {
        let mut heard = Vec::new();
        if millisecond % PERIOD_MS == 0 {
            let raw = raw.map_or_else(|| status(rig).map(|status| status.position), Ok)?;
            let bytes = HitchCommand::Position(raw).to_bytes();
            heard.push(message(Pgn::HITCH_COMMANDS, bytes));
        }
        rig.bench
            .tick_with(&mut rig.board, &heard, &mut rig.said, |_| {})?;
        driven |= rig.is_driven();
    }
    Ok(driven)
}

/// An implement moves the hitch with the operator's consent, and not without.
pub fn consent(setup: &Setup) -> Result<String> {
    let mut rig = Rig::typical(setup)?;
    rig.pick_up()?;
    rig.run(2_000)?;
    let name: Name = NameFields {
        device_class: 6,
        ..NameFields::rear_hitch(77)
    }
    .into();
    let unknown = command(&mut rig, None, 500)? | command(&mut rig, Some(ASKED), 500)?;
    ensure!(!unknown, "a node without an address moves the hitch");
    rig.run(400)?;
    let claim = [message(Pgn::ADDRESS_CLAIMED, name.to_bytes())];
    rig.bench
        .tick_with(&mut rig.board, &claim, &mut rig.said, |_| {})?;
    let unwanted = command(&mut rig, None, 500)? | command(&mut rig, Some(ASKED), 500)?;
    ensure!(!unwanted, "the hitch moves without consent");
    ensure!(status(&rig)?.exit == ExitCode::NoOperator, "no request");
    rig.run(400)?;
    command(&mut rig, None, 500)?;
    rig.bench
        .operator
        .apply(Order::Contact(Contact::Consent, true));
    command(&mut rig, None, 300)?;
    command(&mut rig, Some(ASKED), 4_000)?;
    let off_deg = (rig.bench.angle_deg() - ASKED_DEG).abs();
    ensure!(
        off_deg < 1.0,
        "{off_deg} deg from the implement's set point"
    );
    rig.bench
        .operator
        .apply(Order::Contact(Contact::Hold, true));
    let held = command(&mut rig, Some(20), 1_000)?;
    ensure!(!held, "hold does not end remote control");
    ensure!(
        status(&rig)?.exit == ExitCode::OperatorOverride,
        "the implement is not told why"
    );
    rig.finish()?;
    Ok(format!(
        "{off_deg:.2} deg from the set point of the implement"
    ))
}
