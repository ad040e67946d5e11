//! Start angle of a hitch.
//!
//! A log with the angle contains it. Otherwise it is estimated from the other channels: the pressure at rest depends on
//! the linkage's lever arms, and the stops show the remaining travel.

use hitch_plant::{Channel, Model};

use crate::data::nuisance::CurrentShift;
use crate::data::nuisance::Nuisance;
use crate::data::ready_run::ReadyRun;

/// Number of trial angles minus one between two bounds, and number of refinements of the bounds around the best.
const TRIED: u32 = 16;
const ROUNDS: usize = 4;

/// A run, with an estimated start angle if its log has no angle.
pub(crate) fn started(run: ReadyRun, model: &Model, noise: [f64; 4]) -> ReadyRun {
    if run.on_hitch() && run.start_angle_deg.is_nan() {
        run.started_at(likely_deg(&run, model, noise))
    } else {
        run
    }
}

/// Start angle, degree, with which a model fits the measured channels of a run best.
fn likely_deg(run: &ReadyRun, model: &Model, noise: [f64; 4]) -> f64 {
    let left = |start_angle_deg: f64| left(run, model, noise, start_angle_deg);
    let (low, high) = model.linkage().swing_rad();
    let ends = [low.to_degrees(), high.to_degrees()];
    let (mut low, mut high) = (ends[0], ends[1]);
    let mut best = 0.5 * (low + high);
    for _ in 0..ROUNDS {
        let step = (high - low) / f64::from(TRIED);
        let tried = (0..=TRIED).map(|index| low + f64::from(index) * step);
        let ranked = tried.map(|angle_deg| (left(angle_deg), angle_deg));
        best = ranked
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .map_or(best, |(_, angle_deg)| angle_deg);
        (low, high) = ((best - step).max(ends[0]), (best + step).min(ends[1]));
    }
    best
}

/// Sum of absolute residuals of a run with a start angle: robust against large residuals of missing effects.
fn left(run: &ReadyRun, model: &Model, noise: [f64; 4], start_angle_deg: f64) -> f64 {
    let started = run.started_at(start_angle_deg);
    let trace = started.simulated(model, Nuisance::default(), CurrentShift::default());
    let of_channel = |channel: Channel| {
        let simulated = trace.channel(channel).iter();
        let measured = run.measured[channel.index()].iter().flatten();
        let apart = measured.zip(simulated).map(|(m, s)| (m - s).abs());
        let apart = apart.filter(|apart| apart.is_finite());
        apart.sum::<f64>() / noise[channel.index()]
    };
    let measured = Channel::ALL.into_iter();
    let measured = measured.filter(|channel| run.measured[channel.index()].is_some());
    measured.map(of_channel).sum()
}
