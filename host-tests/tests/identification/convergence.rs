//! A run simulated at the steps of its log agrees with a simulation in very fine steps.
//!
//! The currents are those of a 50 Hz logger with noise, interpolated linearly between samples.

use std::path::Path;

use hitch_campaign::{Campaign, Run};
use hitch_effects::CATALOGUE;
use hitch_identification::data::experiment::Experiment;
use hitch_identification::data::nuisance::Nuisance;
use hitch_plant::simulation::{Trace, simulate};
use hitch_plant::{AddedEffect, Channel, Currents, Effect, Model};
use host_tests::seeds::cases;

/// Steps per sample of the converged solution: half a millisecond each.
const FINER: usize = 40;

/// Largest root mean square deviation of a channel, relative to its own.
const BAR: f64 = 0.001;

/// The same with an effect of typical size.
const BAR_WITH_AN_EFFECT: f64 = 0.002;

/// The peak pressure of an accelerated load depends on the length of the last step before a sample.
const BAR_OF_PEAKS: f64 = 0.004;

/// The same currents in `FINER` steps per sample.
fn finely(time_s: &[f64], currents: &[Currents]) -> (Vec<f64>, Vec<Currents>) {
    let between =
        |from: f64, to: f64, piece: usize| from + (to - from) * piece as f64 / FINER as f64;
    let mut fine = (vec![time_s[0]], vec![currents[0]]);
    for sample in 1..time_s.len() {
        let (from, to) = (currents[sample - 1], currents[sample]);
        for piece in 1..=FINER {
            fine.0
                .push(between(time_s[sample - 1], time_s[sample], piece));
            fine.1.push(Currents {
                lift_a: between(from.lift_a, to.lift_a, piece),
                lower_a: between(from.lower_a, to.lower_a, piece),
            });
        }
    }
    fine
}

fn logged(run: &Run) -> Vec<Currents> {
    let both = run.lift_current_a.iter().zip(&run.lower_current_a);
    both.map(|(&lift_a, &lower_a)| Currents { lift_a, lower_a })
        .collect()
}

/// For each channel: root mean square of the difference over that of the channel, over all runs.
fn shares(pairs: &[(Trace, Trace)]) -> [f64; 4] {
    Channel::ALL.map(|channel| {
        let (mut off, mut all) = (0.0, 0.0);
        for (coarse, fine) in pairs {
            let (coarse, fine) = (coarse.channel(channel), fine.channel(channel));
            let finite = coarse
                .iter()
                .zip(fine)
                .filter(|(a, b)| a.is_finite() && b.is_finite());
            for (a, b) in finite {
                off += (a - b).powi(2);
                all += b.powi(2);
            }
        }
        (off / all).sqrt()
    })
}

fn off(model: &Model, campaign: &Campaign) -> [f64; 4] {
    let experiment = Experiment::new(campaign, model);
    let runs = campaign.runs.iter().zip(&experiment.runs);
    let pairs: Vec<(Trace, Trace)> = runs
        .map(|(run, ready)| {
            let rig = ready.rig(Nuisance::default());
            let currents = logged(run);
            let (time_s, finely) = finely(&run.time_s, &currents);
            let oil_c = ready.oil_temperature_c;
            let coarse = simulate(model, rig, oil_c, &run.time_s, &currents);
            let mut fine = simulate(model, rig, oil_c, &time_s, &finely);
            let samples: Vec<usize> = (0..run.time_s.len()).map(|k| k * FINER).collect();
            fine.keep(&samples);
            (coarse, fine)
        })
        .collect();
    shares(&pairs)
}

fn percent(shares: [f64; 4]) -> String {
    let percent = |share: f64| format!("{:8.4} %", 100.0 * share);
    shares.map(percent).join(" ")
}

fn bar(effect: &dyn Effect) -> f64 {
    if effect.id() == "load-inertia" {
        BAR_OF_PEAKS
    } else {
        BAR_WITH_AN_EFFECT
    }
}

// REQ-DIAG-12
#[test]
fn the_steps_of_a_log_are_fine_enough() {
    let campaign = Path::new(env!("CARGO_MANIFEST_DIR")).join("campaigns/known-threshold");
    let campaign = Campaign::load(&campaign).expect("a shipped campaign");
    println!("pump pressure, cylinder pressure, flow, angle:");
    for model in [hitch_model_file::nominal(), hitch_model_file::dynamic()] {
        let without = off(&model, &campaign);
        println!("{} {}", percent(without), model.name);
        assert!(without.iter().all(|share| *share <= BAR), "{}", model.name);
        for &effect in CATALOGUE.iter().step_by(cases(4, 1)) {
            let with = model.with_effects(vec![AddedEffect::typical(effect)]);
            let with = off(&with, &campaign);
            println!("{} {}", percent(with), effect.id());
            let fine = with.iter().all(|share| *share <= bar(effect));
            assert!(fine, "{} {}", model.name, effect.id());
        }
    }
}
