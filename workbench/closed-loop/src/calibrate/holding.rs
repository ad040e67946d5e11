//! Limits of the drift monitor for the leakage of a model.
//!
//! A leak lowers a hitch at rest with the speed `v = Q_leak / A`. A correction makes good the distance `d` from the restart
//! band to the stop band, so corrections are due every `d / v`. The monitor forgets one of them after
//! `hold.correction_memory`, and reports a leak that needs more. With that time `d / (m v)` the leak of the model is
//! permitted, and one that is larger by the factor `m` is reported. A tight machine keeps the time of the base, and a leak
//! that needs corrections faster than the firmware permits to forget them is reported with the shortest time as well.

use hitch_plant::{Currents, HitchRig, Model, Plant, Rig};
use hitch_quantities::Calibration;
use hitch_quantities::units::Millisecond;

use super::effect_size::found;

/// Factor `m`. Oil of 50 C instead of 40 C leaks as much more.
const MARGIN: f64 = 1.5;
/// The shortest time that the firmware accepts.
const SHORTEST_MEMORY: Millisecond = Millisecond(1_000);
/// Oil temperature for which the conductance of a leak is given, C.
const OIL_TEMPERATURE_C: f64 = 40.0;
/// Time until a leak flows steadily, and in which its sinking is measured, s.
const SETTLING_S: f64 = 0.5;
const SINKING_S: f64 = 1.0;
const STEP_S: f64 = 1e-3;

/// Adapts `calibration`, whose bands are those of the machine.
pub fn adapt(model: &Model, calibration: &mut Calibration) {
    if found(model, "lowering-leakage").is_none() {
        return;
    }
    let position = &calibration.position;
    let made_good_m = 1e-6 * f64::from((position.restart_band - position.stop_band).0);
    let sinking_m_s = sinking_m_s(model);
    if sinking_m_s <= 0.0 {
        return;
    }
    let memory_ms = 1e3 * made_good_m / (MARGIN * sinking_m_s);
    let memory = Millisecond(memory_ms.round() as i32).max(SHORTEST_MEMORY);
    let hold = &mut calibration.hold;
    hold.correction_memory = hold.correction_memory.min(memory);
}

/// Speed at which the heaviest usual load sinks with both coils off, in mid-stroke, m/s.
fn sinking_m_s(model: &Model) -> f64 {
    let (low_rad, high_rad) = model.linkage().swing_rad();
    let [.., load_kg] = model.usual_loads_kg();
    let rig = Rig::Hitch(HitchRig {
        load_kg,
        start_angle_rad: 0.5 * (low_rad + high_rad),
    });
    let mut plant = Plant::new(model, rig, OIL_TEMPERATURE_C, Currents::default());
    let mut after_m = |time_s: f64| {
        for _ in 0..(time_s / STEP_S) as usize {
            plant.step(Currents::default(), STEP_S);
        }
        plant.state().piston_m
    };
    let from_m = after_m(SETTLING_S);
    (from_m - after_m(SINKING_S)) / SINKING_S
}
