//! Mistakes of the first flash: a board with another crystal, and an image that was not finished.

use anyhow::{Context, Result, ensure};
use hitch_protocols::can::Frame;
use hitch_protocols::j1939::{Id, Pgn, Trouble};

use super::rig::{READY_MS, Rig};
use super::setup::Setup;
use crate::Conditions;

/// Time within which all active codes are broadcast at least once after an address is claimed, ms.
pub const REPORTED_MS: usize = 1_500;

/// Nominal frequency of the internal oscillator, Hz.
const INTERNAL_HZ: f64 = 16e6;

/// The operator picks the hitch up and lifts it; no coil follows, and `trouble` is reported on the bus.
fn is_refused(rig: &mut Rig<'_>, trouble: Trouble) -> Result<()> {
    rig.run(READY_MS)?;
    ensure!(rig.board.chip().pwm.updates > 0, "the ECU does not start");
    let angle_deg = rig.bench.angle_deg();
    for (lever_deg, milliseconds) in [
        (angle_deg + 3.0, 300),
        (angle_deg - 3.0, 300),
        (125.0, REPORTED_MS),
    ] {
        rig.lever(lever_deg, milliseconds)?;
    }
    ensure!(!rig.was_driven, "a coil was driven");
    ensure!(
        reports(&rig.said, trouble),
        "{trouble:?} is not among the trouble codes"
    );
    rig.finish()
}

/// Whether a code is in a DM1, which is a frame or, with several codes, a broadcast of data packets.
pub fn reports(said: &[Frame], trouble: Trouble) -> bool {
    let code = trouble.code();
    let [low, middle, high, _] = code.spn.to_le_bytes();
    let wanted = [low, middle, high << 5 | code.fmi];
    let group = |frame: &Frame| frame.extended_data_id().map(Id::unpack);
    let of_group = |is_wanted: fn(Pgn) -> bool| {
        said.iter()
            .filter(move |frame| group(frame).is_some_and(|id| is_wanted(id.pgn)))
    };
    let alone =
        of_group(|pgn| pgn == Pgn::DM1).any(|frame| frame.data().get(2..5) == Some(&wanted[..]));
    let packets: Vec<u8> = of_group(|pgn| pgn == Pgn::TRANSPORT_DATA)
        .flat_map(|frame| frame.data().get(1..).unwrap_or_default())
        .copied()
        .collect();
    alone || packets.windows(3).any(|bytes| bytes == wanted)
}

/// All codes that are in a DM1.
pub fn reported(said: &[Frame]) -> Vec<Trouble> {
    let all = Trouble::ALL.iter().copied();
    all.filter(|trouble| reports(said, *trouble)).collect()
}

/// Conditions with a crystal that has `share` of its nominal frequency, and this internal oscillator.
fn oscillators(setup: &Setup, share: f64, internal_hz: f64) -> Conditions {
    let typical = Conditions::typical(setup.layout);
    Conditions {
        crystal_hz: share * typical.crystal_hz,
        internal_hz,
        ..typical
    }
}

/// A sound crystal is used with the slowest and the fastest internal oscillator of the data sheet. Further off than these
/// can explain, or another crystal altogether: the part runs from its internal oscillator, no coil is driven, and a trouble
/// code says why.
pub fn wrong_crystal(setup: &Setup) -> Result<String> {
    let [slowest_hz, fastest_hz] = setup.layout.part().internal_hz();
    for internal_hz in [slowest_hz, fastest_hz] {
        let mut rig = Rig::erased(setup, oscillators(setup, 1.0, internal_hz))?;
        rig.pick_up()?;
        rig.lever(125.0, 700)?;
        ensure!(
            rig.is_driven(),
            "the hitch isn't lifted with an internal oscillator of {internal_hz} Hz; reported: {:?}",
            reported(&rig.said)
        );
    }
    let (low, high) = (INTERNAL_HZ / fastest_hz, INTERNAL_HZ / slowest_hz);
    let wrong = [low - 0.01, high + 0.01, 0.5, 1.5];
    for share in wrong {
        let mut rig = Rig::erased(setup, oscillators(setup, share, INTERNAL_HZ))?;
        is_refused(&mut rig, Trouble::Crystal)
            .with_context(|| format!("{share} of the crystal's frequency"))?;
    }
    Ok(format!(
        "used with internal oscillators of {slowest_hz} and {fastest_hz} Hz; {} crystals refused and reported, with the bus at \
         its rate",
        wrong.len()
    ))
}

/// An image without checksum: no coil is driven, and a trouble code says why.
pub fn unsealed_image(setup: &Setup) -> Result<String> {
    let unsealed = Setup {
        image: setup.image.unsealed()?,
        ..setup.clone()
    };
    let mut rig = Rig::typical(&unsealed)?;
    is_refused(&mut rig, Trouble::ImageUnsealed)?;
    Ok("refused and reported".into())
}
