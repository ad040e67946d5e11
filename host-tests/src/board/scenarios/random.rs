//! Random operation with faults: an operator who never rests, wires that break and mend, a busy bus.

use anyhow::{Result, ensure};
use hitch_firmware::ecu::Contact;
use hitch_model::Model;
use hitch_workbench::ecu::Order;

use super::Setup;
use super::faults::FAULTS;
use super::rig::Rig;

/// Names the minutes of machine time; a release runs 60.
const MINUTES_VARIABLE: &str = "HITCH_BOARD_MINUTES";
const MINUTES: f64 = 0.25;
const SEED: u64 = 20_261_124;
/// A persistent fault of any row has cut the coils by then, ms: the slowest row, and the state before.
const CUT_MS: u32 = 60;

/// Runs it; both coils are never driven together, a fault cuts them, and nothing resets the ECU.
pub fn operation(setup: &Setup) -> Result<String> {
    let minutes =
        std::env::var(MINUTES_VARIABLE).map_or(Ok(MINUTES), |text| text.parse::<f64>())?;
    let model = Model::nominal();
    let mut rig = Rig::typical(setup, &model)?;
    rig.pick_up()?;
    let mut random = fastrand::Rng::with_seed(SEED);
    let (mut faults, mut driven_ms) = (0_u32, 0_u32);
    let mut fault: Option<(usize, u32)> = None;
    let mut left_ms = 0_u32;
    for step in 0..(minutes * 60e3) as u32 {
        if left_ms == 0 {
            left_ms = random.u32(50..3_000);
            fault = match random.u32(0..4) {
                0 => {
                    faults += 1;
                    Some((random.usize(0..FAULTS.len()), step))
                }
                _ => None,
            };
            act(&mut rig, &mut random);
        }
        left_ms -= 1;
        rig.said.clear();
        rig.tick_with(|contacts| {
            if let Some((index, _)) = fault {
                (FAULTS[index].inject)(contacts, step as usize);
            }
        })?;
        let chip = rig.board.chip();
        let both = chip.duty(0) > 0.0 && chip.duty(1) > 0.0;
        ensure!(!both, "seed {SEED}: both coils are driven after {step} ms");
        driven_ms += u32::from(rig.is_driven());
        if let Some((index, since)) = fault
            && step - since > CUT_MS
            && FAULTS[index].always_shows
        {
            let name = FAULTS[index].name;
            ensure!(
                !rig.is_driven(),
                "seed {SEED}: a coil is driven after {step} ms with {name}"
            );
        }
        ensure!(
            rig.board.resets.is_empty(),
            "seed {SEED}: reset after {step} ms"
        );
    }
    rig.finish()?;
    ensure!(driven_ms > 0, "no coil was ever driven");
    Ok(format!(
        "seed {SEED}, {minutes} minutes: {faults} faults, a coil driven for {:.1} s",
        f64::from(driven_ms) * 1e-3
    ))
}

/// Something that an operator does.
fn act(rig: &mut Rig<'_>, random: &mut fastrand::Rng) {
    let angle_deg = rig.bench.angle_deg();
    let operator = &mut rig.bench.operator;
    operator.obey(Order::ReleaseButtons);
    operator.obey(Order::Contact(Contact::FieldMode, true));
    match random.u32(0..10) {
        0 => operator.obey(Order::Contact(Contact::Up, true)),
        1 => operator.obey(Order::Contact(Contact::Down, true)),
        2 => operator.obey(Order::Contact(Contact::FieldMode, false)),
        3 | 4 => operator.obey(Order::Lever(angle_deg)),
        _ => operator.obey(Order::Lever(50.0 + 80.0 * random.f64())),
    }
}
