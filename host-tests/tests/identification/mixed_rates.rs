//! A campaign whose log has channels of several rates: noise and errors are those of a log with one rate.

use std::fs;
use std::path::Path;

use hitch_campaign::{Bench, Campaign};
use hitch_identification::data::experiment::Experiment;
use hitch_identification::data::problem::Problem;
use hitch_identification::explanation::explain::fit_base;
use hitch_plant::simulation::simulate;
use hitch_plant::{Channel, Currents, HitchRig, Model, Rig};
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;
use truth_rigs::category_three::compressed_mdf::{Group, bytes};
use truth_rigs::second_rig::manoeuvres::{Manoeuvre, Plan, runs};

/// Step of the simulated truth, s.
const STEP_S: f64 = 1e-3;
/// Steps of the truth between two samples of the fast group, and of the slow one.
const FAST: usize = 10;
const SLOW: usize = 40;
/// Steps by which the slow group is sampled later.
const LATER: usize = 3;
/// Noise of the instruments, one sigma: A, and by channel.
const CURRENT_SIGMA_A: f64 = 0.003;
const SIGMA: [(Channel, f64); 3] = [
    (Channel::PumpPressure, 0.5),
    (Channel::CylinderPressure, 0.4),
    (Channel::RockerAngle, 0.06),
];
/// Largest relative difference of noise and errors.
const ALIKE: f64 = 0.15;
const SEED: u64 = 31;
/// Runs of the campaign.
const RUNS: usize = 6;

const COLUMNS: &str = "
[columns]
lift_current_a = \"Lift\"
lower_current_a = \"Lower\"
pump_pressure_bar = \"Pump\"
cylinder_pressure_bar = \"Cylinder\"
rocker_angle_deg = \"Angle\"
";

/// Layout of a log.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Rates {
    /// Every channel in one group.
    One,
    /// The angle in a slow group of its own.
    SlowAngle,
}

/// Noisy samples from a step on, every so many steps.
fn sampled(
    truth: &[f64],
    (first, every): (usize, usize),
    sigma: f64,
    random: &mut Pcg64,
) -> Vec<f64> {
    let samples = truth.iter().skip(first).step_by(every);
    samples
        .map(|value| {
            let noise: f64 = StandardNormal.sample(random);
            value + sigma * noise
        })
        .collect()
}

fn log(model: &Model, manoeuvre: &Manoeuvre, rates: Rates, random: &mut Pcg64) -> Vec<u8> {
    let Bench::Hitch { load_kg } = manoeuvre.bench else {
        panic!("a run on the hitch");
    };
    let steps = (manoeuvre.duration_s / STEP_S).round() as usize;
    let time_s: Vec<f64> = (0..=steps).map(|step| step as f64 * STEP_S).collect();
    let current = |time_s: &f64| Currents {
        lift_a: manoeuvre.lift.at(*time_s),
        lower_a: manoeuvre.lower.at(*time_s),
    };
    let currents: Vec<Currents> = time_s.iter().map(current).collect();
    let rig = Rig::Hitch(HitchRig {
        load_kg,
        start_angle_rad: manoeuvre.start_deg.to_radians(),
    });
    let trace = simulate(model, rig, manoeuvre.oil_temperature_c, &time_s, &currents);
    let places = |(first, every): (usize, usize)| {
        time_s.iter().copied().skip(first).step_by(every).collect()
    };
    let lift_a: Vec<f64> = currents.iter().map(|current| current.lift_a).collect();
    let lower_a: Vec<f64> = currents.iter().map(|current| current.lower_a).collect();
    let fast = (0, FAST);
    let slow = match rates {
        Rates::One => fast,
        Rates::SlowAngle => (LATER, SLOW),
    };
    let [pump, cylinder, angle] = SIGMA.map(|(channel, sigma)| {
        let place = if channel == Channel::RockerAngle {
            slow
        } else {
            fast
        };
        sampled(trace.channel(channel), place, sigma, random)
    });
    bytes(&[
        Group {
            time_s: places(fast),
            channels: vec![
                ("Lift", "A", sampled(&lift_a, fast, CURRENT_SIGMA_A, random)),
                (
                    "Lower",
                    "A",
                    sampled(&lower_a, fast, CURRENT_SIGMA_A, random),
                ),
                ("Pump", "bar", pump),
                ("Cylinder", "bar", cylinder),
            ],
        },
        Group {
            time_s: places(slow),
            channels: vec![("Angle", "deg", angle)],
        },
    ])
}

fn campaign(folder: &Path, model: &Model, rates: Rates) -> Campaign {
    let mut random = Pcg64::seed_from_u64(SEED);
    let on_hitch = |run: &Manoeuvre| matches!(run.bench, Bench::Hitch { .. });
    let manoeuvres = runs(Plan::Lab, &mut random).into_iter().filter(on_hitch);
    let mut manifest = format!("format = 1\nname = \"rates\"\nsample_rate_hz = 100\n{COLUMNS}");
    for (index, manoeuvre) in manoeuvres.take(RUNS).enumerate() {
        let file = format!("{index}.mf4");
        fs::write(
            folder.join(&file),
            log(model, &manoeuvre, rates, &mut random),
        )
        .unwrap();
        let Bench::Hitch { load_kg } = manoeuvre.bench else {
            continue;
        };
        manifest += &format!(
            "\n[[run]]\nfile = \"{file}\"\nbench = \"hitch\"\nload_kg = {load_kg}\noil_temperature_c = {}\n",
            manoeuvre.oil_temperature_c
        );
    }
    fs::write(folder.join("campaign.toml"), manifest).unwrap();
    Campaign::load_with(folder, model.linkage()).unwrap()
}

/// Noise and error in sigma of each channel, and the error of all.
fn figures(rates: Rates) -> ([f64; 3], [f64; 3], f64) {
    let model = hitch_model_file::dynamic();
    let folder = tempfile::tempdir().unwrap();
    let campaign = campaign(folder.path(), &model, rates);
    let experiment = Experiment::new(&campaign, &model);
    let fit = fit_base(Problem::new(&experiment, &model));
    let noise = SIGMA.map(|(channel, _)| experiment.noise[channel.index()]);
    let errors = SIGMA.map(|(channel, _)| fit.channel_error(channel.index()));
    (noise, errors, fit.error())
}

#[test]
fn a_slow_channel_has_the_noise_and_error_of_a_log_with_one_rate() {
    println!("seed {SEED}");
    let (one, mixed) = (figures(Rates::One), figures(Rates::SlowAngle));
    println!(
        "one rate: noise {:.4?}, errors {:.3?}, all {:.3}",
        one.0, one.1, one.2
    );
    println!(
        "40 ms angle: noise {:.4?}, errors {:.3?}, all {:.3}",
        mixed.0, mixed.1, mixed.2
    );
    let alike = |a: f64, b: f64| (a / b - 1.0).abs() < ALIKE;
    for (index, (channel, sigma)) in SIGMA.into_iter().enumerate() {
        let name = channel.key();
        assert!(
            alike(mixed.0[index], sigma),
            "noise of {name}: {}",
            mixed.0[index]
        );
        assert!(alike(mixed.0[index], one.0[index]), "noise of {name}");
        assert!(alike(mixed.1[index], one.1[index]), "error of {name}");
    }
    assert!(alike(mixed.2, one.2));
}
