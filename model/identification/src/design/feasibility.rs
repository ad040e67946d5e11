//! Whether a machine can carry out a manoeuvre.

use hitch_plant::{Channel, Model};

use crate::design::levels::Levels;
use crate::design::plan::{Manoeuvre, RunPlan, Stand};
use crate::parallel;

/// Largest pressure over the relief setting: the usual proof pressure of hydraulic components over their rated pressure.
const PROOF: f64 = 1.5;

/// Whether the loads can be lifted all over the swing, and the simulated pressures stay below the proof pressure with
/// `model` as the machine. Currents are within the flow curves by construction.
#[must_use]
pub fn is_feasible(manoeuvre: &Manoeuvre, levels: &Levels, model: &Model, rate_hz: f64) -> bool {
    is_liftable(manoeuvre, levels) && is_within_proof(manoeuvre, levels, model, rate_hz)
}

/// Whether the loads can be lifted all over the swing; without a simulation.
#[must_use]
pub fn is_liftable(manoeuvre: &Manoeuvre, levels: &Levels) -> bool {
    manoeuvre.runs.iter().all(|run| match run.stand {
        Stand::Hitch { load_kg, .. } => load_kg <= levels.capacity_kg,
        Stand::Flow { .. } => true,
    })
}

/// Whether the simulated pressures stay below the proof pressure.
#[must_use]
pub fn is_within_proof(
    manoeuvre: &Manoeuvre,
    levels: &Levels,
    model: &Model,
    rate_hz: f64,
) -> bool {
    let peak_bar = |run: &RunPlan| {
        let log = run.log(model, rate_hz, Channel::ALL.map(|_| true));
        let pressures = [Channel::PumpPressure, Channel::CylinderPressure];
        let samples = pressures
            .into_iter()
            .filter_map(|channel| log.channel(channel).map(<[f64]>::to_vec));
        samples.flatten().fold(0.0, f64::max)
    };
    let peaks_bar = parallel::map(&manoeuvre.runs, peak_bar);
    peaks_bar
        .into_iter()
        .all(|peak_bar| peak_bar <= PROOF * levels.relief_bar)
}
