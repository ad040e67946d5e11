//! The CAN bus.

use anyhow::{Result, ensure};
use embedded_can::{ExtendedId, Id, StandardId};
use hitch_protocols::can::Frame;
use hitch_protocols::j1939::Trouble;

use super::first_flash::{REPORTED_MS, reports};
use super::rig::Rig;
use super::setup::Setup;

/// Thrown off the bus by errors, the controller comes back by itself, and a trouble code reports it.
pub fn bus_off(setup: &Setup) -> Result<String> {
    let mut rig = Rig::typical(setup)?;
    rig.pick_up()?;
    let before = rig.said.len();
    ensure!(before > 10, "only {before} frames in the first second");
    let chip = rig.board.chip();
    let now_ns = chip.now_ns;
    chip.can.go_off(&mut chip.registers, now_ns);
    chip.schedule();
    let mut back_ms = None;
    for millisecond in 0..500 {
        rig.said.clear();
        rig.tick_with(|_| {})?;
        if back_ms.is_none() && !rig.said.is_empty() {
            back_ms = Some(millisecond);
        }
    }
    let back_ms = back_ms.ok_or_else(|| anyhow::anyhow!("the ECU never sends again"))?;
    rig.lever(100.0, 3_000)?;
    ensure!(
        (rig.bench.angle_deg() - 100.0).abs() < 1.0,
        "the hitch does not follow"
    );
    ensure!(
        reports(&rig.said, Trouble::BusOff),
        "bus-off is not among the trouble codes"
    );
    rig.finish()?;
    Ok(format!("the ECU sends again after {back_ms} ms"))
}

/// The shortest frames, one after the other: no pulse of a move differs from those on a quiet bus, and no frame is lost,
/// since a move changes no flash. Then the controller loses one frame, and a trouble code reports it.
pub fn flooded(setup: &Setup) -> Result<String> {
    let mut angles = Vec::new();
    for floods in [false, true] {
        let mut rig = Rig::typical(setup)?;
        rig.pick_up()?;
        rig.bench
            .operator
            .apply(hitch_ecu_host::ecu::Order::Lever(110.0));
        for step in 0..2_000_u32 {
            let heard = if floods { frames(step) } else { Vec::new() };
            rig.bench
                .tick_with(&mut rig.board, &heard, &mut rig.said, |_| {})?;
        }
        angles.push(rig.bench.angle_deg());
        let lost = rig.board.chip().can.lost;
        ensure!(lost == 0, "{lost} frames lost");
        for is_lost in [false, true] {
            if is_lost {
                rig.board.chip().can.lose();
            }
            rig.said.clear();
            rig.run(REPORTED_MS)?;
            ensure!(
                reports(&rig.said, Trouble::FramesLost) == is_lost,
                "a frame was lost: {is_lost}, and the trouble codes do not say the same"
            );
        }
        rig.finish()?;
    }
    let difference = (angles[0] - angles[1]).abs();
    ensure!(
        difference < 0.3,
        "the hitch ends {difference} deg from where it does on a quiet bus"
    );
    Ok(format!(
        "the hitch ends within {difference:.3} deg; no frame lost in two seconds, and one that is lost is reported"
    ))
}

/// As many frames as fit into a millisecond, of all kinds.
fn frames(step: u32) -> Vec<Frame> {
    let mut random = fastrand::Rng::with_seed(u64::from(step));
    let frame = |index: u32| {
        let bits = random.u32(..);
        let id = match (step + index) % 3 {
            0 => StandardId::new(bits as u16 & 0x7FF).map(Id::Standard),
            _ => ExtendedId::new(bits & 0x1FFF_FFFF).map(Id::Extended),
        };
        Frame::data_frame(id?, &bits.to_le_bytes()[..(bits % 2) as usize])
    };
    (0..4).filter_map(frame).collect()
}
