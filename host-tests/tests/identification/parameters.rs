//! Parts of the identification compared with closed forms, and the whole on oscillating pressures.

use std::path::Path;

use fastrand::Rng;
use hitch_campaign::Campaign;
use hitch_effects::find;
use hitch_identification::data::clocks::Clocks;
use hitch_identification::data::conditioning::Drive;
use hitch_identification::data::experiment::Experiment;
use hitch_identification::data::noise::from_second_differences;
use hitch_identification::data::nuisance::CurrentShift;
use hitch_identification::data::nuisance::Nuisance;
use hitch_identification::data::problem::Problem;
use hitch_identification::explanation::explain::{Verdict, explain};
use hitch_identification::selection::evidence::variance_inflation;
use hitch_plant::simulation::Trace;
use hitch_plant::{AddedEffect, Channel, Currents};

/// Standard normal numbers (Box & Muller).
fn normal(rng: &mut Rng) -> f64 {
    let radius = (-2.0 * (1.0 - rng.f64()).ln()).sqrt();
    radius * (std::f64::consts::TAU * rng.f64()).cos()
}

fn shipped(name: &str) -> Campaign {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("campaigns")
        .join(name);
    Campaign::load(&folder).expect("a shipped campaign")
}

/// A cached trace equals a new simulation, and is never that of another model.
#[test]
fn cached_traces_belong_to_their_model() {
    let campaign = shipped("clean-dynamic");
    let friction = AddedEffect::typical(find("coulomb-friction").expect("an effect"));
    let off = AddedEffect::null(friction.effect);
    let nominal = hitch_model_file::nominal();
    let mut twice = nominal.clone();
    twice.effects = vec![friction.clone(), friction.clone()];
    let models = [
        nominal.clone(),
        nominal.with_effects(vec![friction]),
        nominal.with_effects(vec![off]),
        twice,
        hitch_model_file::dynamic(),
    ];
    let experiment = Experiment::new(&campaign, &nominal);
    let loads = [-0.01, 0.0, 0.01].map(|load| Nuisance { load });
    let shifts = [(0.0, 0.0), (0.005, 0.0), (0.0, 1.0)];
    let shifts = shifts.map(|(later_s, spreads)| CurrentShift { later_s, spreads });
    for run in &experiment.runs[..6] {
        // Twice, so that the second time most are kept.
        for _ in 0..2 {
            for model in &models {
                for (&load, &shift) in loads.iter().zip(&shifts) {
                    let kept = run.trace(model, load, shift);
                    let anew = run.simulated(model, load, shift);
                    let bits = |trace: &Trace| -> Vec<u64> {
                        let channels = trace.channels.iter().flatten();
                        channels.map(|value| value.to_bits()).collect()
                    };
                    assert!(bits(&kept) == bits(&anew), "{} of {}", run.file, model.name);
                }
            }
        }
    }
}

#[test]
fn noise_is_seen_through_a_manoeuvre() {
    let mut rng = Rng::with_seed(1);
    let record: Vec<f64> = (0..2000)
        .map(|k| {
            let phase = f64::from(k % 500) / 500.0;
            30.0 * (4.0 * phase - 1.0).clamp(0.0, 1.0) + 0.1 * normal(&mut rng)
        })
        .collect();
    let time_s: Vec<f64> = (0..record.len()).map(|k| 0.02 * k as f64).collect();
    let sigma = from_second_differences(&time_s, &record).expect("enough samples");
    assert!((sigma / 0.1 - 1.0).abs() < 0.06, "{sigma}, not 0.1");
}

#[test]
fn conditioning_a_current_removes_noise_and_keeps_corners() {
    let mut rng = Rng::with_seed(2);
    let sigma_a = 0.003;
    let time_s: Vec<f64> = (0..600).map(|k| f64::from(k) * 0.02).collect();
    let truth: Vec<f64> = time_s
        .iter()
        .map(|t| 2.0 * ((t - 2.0) / 0.2).min((8.0 - t) / 0.2).clamp(0.0, 1.0))
        .collect();
    let logged: Vec<f64> = truth
        .iter()
        .map(|a| a + sigma_a * normal(&mut rng))
        .collect();
    let sigma = Currents {
        lift_a: sigma_a,
        lower_a: sigma_a,
    };
    let drive = Drive::new(&time_s, &logged, &vec![0.0; 600], sigma, 0.0);
    let off: Vec<f64> = drive
        .currents
        .iter()
        .zip(&truth)
        .map(|(c, t)| c.lift_a - t)
        .collect();
    let plateau = &off[150..350];
    let rms = (plateau.iter().map(|e| e * e).sum::<f64>() / 200.0).sqrt();
    assert!(
        rms < sigma_a / 3.0,
        "{rms} A of {sigma_a} A are left on the plateau"
    );
    let worst = off.iter().fold(0.0_f64, |worst, e| worst.max(e.abs()));
    assert!(worst < 4.5 * sigma_a, "{worst} A off at a corner");
}

/// For a slow signature, residuals of first-order autocorrelation inflate the variance by `(1 + rho) / (1 - rho)`; for
/// white residuals not at all.
#[test]
fn autocorrelation_is_counted() {
    let (campaign, model) = (shipped("clean-steady"), hitch_model_file::nominal());
    let mut experiment = Experiment::new(&campaign, &model);
    experiment.runs.retain(|run| run.file == "hold_250kg.csv");
    let samples = experiment.runs[0].len();
    let inflation = |rho: f64| {
        let mut rng = Rng::with_seed(3);
        let mut mean = 0.0;
        for _ in 0..40 {
            let mut last = normal(&mut rng);
            let residual: Vec<f64> = (0..4 * samples)
                .map(|_| {
                    last = rho * last + (1.0 - rho * rho).sqrt() * normal(&mut rng);
                    last
                })
                .collect();
            mean += variance_inflation(&experiment, &[residual], &[vec![1.0; 4 * samples]]) / 40.0;
        }
        mean
    };
    let (white, slow) = (inflation(0.0), inflation(0.8));
    assert!((1.0..1.5).contains(&white), "white: {white}");
    assert!((7.5..10.0).contains(&slow), "slow: {slow}, not 9");
}

/// A campaign of the dynamic plant with one more effect: the currents of a measured campaign, simulated with the model's
/// own plant, another load and new noise. It tests the search on ringing pressures, not the plant.
fn ringing_campaign(hidden: &AddedEffect, seed: u64) -> Campaign {
    let mut campaign = shipped("clean-dynamic");
    let model = hitch_model_file::dynamic();
    let experiment = Experiment::new(&campaign, &model);
    let rig = model.with_effects(vec![hidden.clone()]);
    let mut rng = Rng::with_seed(seed);
    for (run, ready) in campaign.runs.iter_mut().zip(&experiment.runs) {
        let nuisance = Nuisance {
            load: 0.003 * normal(&mut rng),
        };
        let trace = ready.simulate(&rig, nuisance, &Clocks::default());
        for channel in Channel::ALL {
            if let Some(measured) = &mut run.channels[channel.index()] {
                let sigma = experiment.noise[channel.index()];
                for (value, truth) in measured.iter_mut().zip(trace.channel(channel)) {
                    *value = truth + sigma * normal(&mut rng);
                }
            }
        }
    }
    campaign
}

#[test]
fn friction_is_named_where_pressures_ring() {
    let model = hitch_model_file::dynamic();
    let hidden = AddedEffect {
        effect: find("coulomb-friction").expect("in the catalogue"),
        values: vec![350.0],
    };
    let campaign = ringing_campaign(&hidden, 4);
    let explanation = explain(
        Problem::new(&Experiment::new(&campaign, &model), &model),
        &|_| {},
    );
    let named: Vec<&str> = explanation
        .steps
        .iter()
        .map(|step| step.effect.id())
        .collect();
    assert_eq!(named, ["coulomb-friction"]);
    assert_eq!(explanation.verdict, Verdict::Explained);
    let force_n = explanation.steps[0].values[0];
    assert!(
        (force_n / 350.0 - 1.0).abs() < 0.05,
        "{force_n} N, not 350 N"
    );
}

/// Holding alone has no information on valves that never open.
#[test]
fn a_campaign_that_only_holds_cannot_decide() {
    let mut campaign = shipped("clean-steady");
    campaign.runs.retain(|run| run.file == "hold_250kg.csv");
    let model = hitch_model_file::nominal();
    let explanation = explain(
        Problem::new(&Experiment::new(&campaign, &model), &model),
        &|_| {},
    );
    assert_eq!(explanation.verdict, Verdict::NotEnoughData);
    assert!(
        explanation
            .next_experiment
            .is_some_and(|next| next.to_string().contains("lift"))
    );
}
