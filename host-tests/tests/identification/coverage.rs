//! Confidence intervals of the parameters of every effect contain the true values, on simulated lab campaigns.
//!
//! The truth is the project's own plant, so that every parameter has the meaning of the catalogue. Currents vary
//! between samples, loads have weighing errors, instruments have noise and finite resolution.
//! `HITCH_SEEDS=100` tests every effect with a hundred campaigns, `HITCH_COVERAGE_EFFECT=spool-lag` that effect alone.

use hitch_effects::CATALOGUE;
use hitch_identification::data::experiment::Experiment;
use hitch_identification::data::problem::Problem;
use hitch_identification::explanation::explain::fit_base;
use hitch_identification::search::single_effects::try_effects;
use hitch_plant::{AddedEffect, Dynamics, Effect, Model};
use host_tests::seeds::{cases, seeds};
use host_tests::short_moves::few_runs;
use rand::SeedableRng;
use rand_pcg::Pcg64;
use rayon::prelude::*;
use truth_rigs::simulated_lab::campaign;

/// Default number of seeds of an effect.
const FEW_SEEDS: u64 = 1;

/// The same with `HITCH_THOROUGH`.
const SEEDS: u64 = 2;

/// Standard deviations by which an estimate may miss, were its interval a normal distribution's.
const WIDTH: f64 = 1.96;

/// One campaign's estimates of an effect's parameters, as distances from the truth in standard deviations.
type Distances = Vec<f64>;

// REQ-DIAG-05
#[test]
fn intervals_hold_the_truth() {
    let seeds = seeds(cases(FEW_SEEDS, SEEDS));
    let (mut held, mut judged, mut too_few) = (0, 0, Vec::new());
    println!("effect                    parameters held  rms distance, sigmas");
    let only = std::env::var("HITCH_COVERAGE_EFFECT").ok();
    let asked = |effect: &&&dyn Effect| only.as_ref().is_none_or(|id| effect.id() == id);
    for effect in CATALOGUE.iter().filter(asked) {
        let distances: Vec<Distances> = (0..seeds)
            .into_par_iter()
            .map(|seed| distances(*effect, seed))
            .collect();
        let all: Vec<f64> = distances.concat();
        let inside = all
            .iter()
            .filter(|distance| distance.abs() <= WIDTH)
            .count();
        let rms = (all.iter().map(|d| d * d).sum::<f64>() / all.len() as f64).sqrt();
        println!(
            "{:<25} {inside:>4} of {:<4} {rms:.2}",
            effect.id(),
            all.len()
        );
        held += inside;
        judged += all.len();
        if (all.len() - inside) as f64 > misses_allowed(all.len()) {
            too_few.push((effect.id(), distances));
        }
    }
    let share = held as f64 / judged as f64;
    println!("all: {held} of {judged}, {:.1} %", 100.0 * share);
    assert!(too_few.is_empty(), "intervals too narrow: {too_few:?}");
    assert!(share >= 0.9, "{held} of {judged}");
}

/// Misses that one effect in a thousand exceeds if a twentieth is to be missed: mean and three deviations.
fn misses_allowed(judged: usize) -> f64 {
    let mean = 0.05 * judged as f64;
    mean + 3.0 * (0.95 * mean).sqrt() + 0.5
}

fn distances(effect: &'static dyn Effect, seed: u64) -> Distances {
    let mut random = Pcg64::seed_from_u64(seed);
    let truth = AddedEffect::typical(effect);
    let nominal = starting_point(effect);
    let rig = nominal.with_effects(vec![truth.clone()]);
    let campaign = campaign(&rig, &mut random);
    let campaign = match effect.needs() {
        Some(Dynamics::Dynamic) => few_runs(campaign),
        _ => campaign,
    };
    let experiment = Experiment::new(&campaign, &nominal);
    let base = fit_base(Problem::new(&experiment, &nominal));
    let candidates = try_effects(
        Problem::new(&experiment, &nominal),
        &base,
        &[effect],
        &|_| {},
    );
    let found = candidates.first().expect("one effect was tried");
    let intervals = found.intervals.iter().zip(found.values());
    intervals
        .zip(&truth.values)
        .map(|((&interval, &value), &truth)| distance(value, interval, truth))
        .collect()
}

/// How many deviations too large a value is, by the half of its 95 % interval in which the truth lies.
fn distance(value: f64, (low, high): (f64, f64), truth: f64) -> f64 {
    let half = if truth < value {
        value - low
    } else {
        high - value
    };
    let distance = WIDTH * (value - truth) / half;
    if (low..=high).contains(&truth) {
        // An interval that an end of the range has cut may be shorter than the estimate's error.
        distance.clamp(-WIDTH, WIDTH)
    } else {
        // NaN, too, is a miss: where the screen found nothing there is no interval.
        distance
    }
}

fn starting_point(effect: &dyn Effect) -> Model {
    match effect.needs() {
        Some(Dynamics::Dynamic) => hitch_model_file::dynamic(),
        _ => hitch_model_file::nominal(),
    }
}
