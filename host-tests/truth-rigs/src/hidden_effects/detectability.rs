//! Detectability of the hidden effects of a case in its measurements.

use hitch_campaign::Bench;

use crate::second_rig::campaign_writer::{LOAD_SIGMA, PlannedRun, perfect_readings, planned_runs};
use crate::second_rig::draw::{Case, Hidden};
use crate::second_rig::instruments::CHANNEL_SIGMA;
use crate::second_rig::test_stand::{Reading, SAMPLE_RATE_HZ};

/// Prior sigma of the skew between currents and channels, s: a quarter of a sample.
const SKEW_SIGMA_S: f64 = 0.005;

/// Root mean square over the logged samples of what a hidden effect changes, in sigmas, less what a wrong weight of
/// each run and a skewed clock could imitate.
///
/// The rig itself is asked, with and without the effect: no model has a say.
#[must_use]
pub fn detectability(case: &Case, hidden: &Hidden) -> f64 {
    let runs = planned_runs(case);
    let physics = case.physics();
    let without = case.physics_with(|other| other.what.id != hidden.what.id);
    let whole = perfect_readings(case, &runs, &physics);
    let without = perfect_readings(case, &runs, &without);
    let heavier = perfect_readings(case, &heavier(&runs), &physics);
    let mut signatures = Vec::new();
    let mut skews = Vec::new();
    for ((whole, without), heavier) in whole.iter().zip(&without).zip(&heavier) {
        let mut signature = whitened(case, whole, without);
        let load = whitened(case, heavier, whole);
        let mut skew = skewed(case, whole);
        project(&load, &mut signature);
        project(&load, &mut skew);
        signatures.extend(signature);
        skews.extend(skew);
    }
    project(&skews, &mut signatures);
    (dot(&signatures, &signatures) / signatures.len().max(1) as f64).sqrt()
}

fn heavier(runs: &[PlannedRun]) -> Vec<PlannedRun> {
    let mut heavier = runs.to_vec();
    for run in &mut heavier {
        if matches!(run.manoeuvre.bench, Bench::Hitch { .. }) {
            run.circumstances.load_factor *= 1.0 + LOAD_SIGMA;
        }
    }
    heavier
}

/// Difference of two records over the channels that are logged, in sigmas.
fn whitened(case: &Case, a: &[Reading], b: &[Reading]) -> Vec<f64> {
    let channels = (0..4).filter(|&channel| case.instruments.logged[channel]);
    channels
        .flat_map(|channel| {
            a.iter()
                .zip(b)
                .map(move |(a, b)| (a[channel] - b[channel]) / CHANNEL_SIGMA[channel])
        })
        .filter(|value| value.is_finite())
        .collect()
}

/// Effect of a clock offset of one sigma on a record.
fn skewed(case: &Case, record: &[Reading]) -> Vec<f64> {
    let share = SKEW_SIGMA_S * SAMPLE_RATE_HZ;
    let late: Vec<Reading> = (0..record.len())
        .map(|sample| {
            let before = record[sample.saturating_sub(1)];
            std::array::from_fn(|channel| {
                let here = record[sample][channel];
                here + share * (before[channel] - here)
            })
        })
        .collect();
    whitened(case, &late, record)
}

/// Projects out of `signature` the part that `nuisance` (one prior sigma of it) can imitate.
fn project(nuisance: &[f64], signature: &mut [f64]) {
    let share = dot(nuisance, signature) / (dot(nuisance, nuisance) + 1.0);
    for (value, nuisance) in signature.iter_mut().zip(nuisance) {
        *value -= share * nuisance;
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
