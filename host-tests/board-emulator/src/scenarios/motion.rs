//! Normal work.

use anyhow::{Result, ensure};

use super::rig::Rig;
use super::setup::Setup;

/// Angles that the lever is moved to, degree.
const UP_DEG: f64 = 115.0;
const DOWN_DEG: f64 = 70.0;
/// How far from the set point a move may end, degree: the calibration is not that of this plant.
const NEAR_DEG: f64 = 1.0;

/// Lifts, holds and lowers; checks pulses, instructions and initialisation.
pub fn lift_hold_lower(setup: &Setup) -> Result<String> {
    let mut rig = Rig::typical(setup)?;
    rig.pick_up()?;
    let chip = rig.board.chip();
    (chip.watchdog.longest_ns, chip.instructions_to_drive) = (0.0, 0);
    let mut off = Vec::new();
    for target_deg in [UP_DEG, DOWN_DEG, UP_DEG] {
        rig.lever(target_deg, 4_000)?;
        let rest_deg = rig.bench.angle_deg();
        ensure!(
            (rest_deg - target_deg).abs() < NEAR_DEG,
            "the hitch rests at {rest_deg} deg instead of {target_deg}"
        );
        ensure!(!rig.is_driven(), "a coil is driven at rest");
        rig.run(2_000)?;
        off.push((rig.bench.angle_deg() - rest_deg).abs());
    }
    rig.finish()?;
    let worst = off.into_iter().fold(0.0, f64::max);
    ensure!(
        worst < 0.1,
        "the hitch moves by {worst} deg while it is held"
    );
    let chip = rig.board.chip();
    let instructions = chip.instructions_to_drive;
    ensure!(
        (1..=12_000).contains(&instructions),
        "{instructions} instructions from samples to pulses"
    );
    let longest_ms = chip.watchdog.longest_ns * 1e-6;
    Ok(format!(
        "at most {instructions} instructions from samples to pulses, {longest_ms:.2} ms between two kicks of the watchdog"
    ))
}
