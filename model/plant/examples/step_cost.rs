//! Cost of a step of the plant, with and without effects.
//!
//! `cargo run -p hitch-plant --example step_cost [CASE [REPEATS]]` prints the time per step: 4 ms of the dynamic plant, 20 ms of
//! the steady one, driven by noisy currents at 50 Hz. Instructions do not depend on other programs on the machine: run one
//! case under `valgrind --tool=callgrind` with two numbers of repeats, and divide the difference by that of the steps.

use std::hint::black_box;
use std::time::Instant;

use hitch_plant::hooks::effect::full_name;
use hitch_plant::simulation::simulate;
use hitch_plant::{AddedEffect, Currents, Dynamics, HitchRig, Model, Rig};

const SAMPLE_S: f64 = 0.02;
/// Samples of a run: a minute.
const SAMPLES: u32 = 3000;

/// Names of the cases, the plant and its effects.
const CASES: &[(&str, Dynamics, &[&str])] = &[
    ("dynamic", Dynamics::Dynamic, &[]),
    (
        "dynamic-lagging-friction",
        Dynamics::Dynamic,
        &["compensator-droop/lagging", "coulomb-friction"],
    ),
    (
        "dynamic-air-hose",
        Dynamics::Dynamic,
        &["entrained-air", "hose-compliance"],
    ),
    ("steady", Dynamics::Steady, &[]),
    (
        "steady-hysteresis-friction",
        Dynamics::Steady,
        &["solenoid-hysteresis", "coulomb-friction"],
    ),
];

fn model(dynamics: Dynamics, effects: &[&str]) -> Model {
    let base = match dynamics {
        Dynamics::Steady => hitch_model_file::nominal(),
        Dynamics::Dynamic => hitch_model_file::dynamic(),
    };
    let added = effects.iter().map(|name| {
        let mut effects = hitch_effects::CATALOGUE.iter();
        let found = effects.find(|effect| full_name(**effect) == *name);
        AddedEffect::typical(*found.expect("an effect of the catalogue"))
    });
    base.with_effects(added.collect())
}

/// Lifts and lowers alternately, with pauses, and with the noise of a logger.
fn currents() -> Vec<Currents> {
    let mut state = 1_u64;
    let mut noise_a = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        0.02 * ((state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5)
    };
    let pulse = |time_s: f64| {
        let (rise, fall) = (time_s / 0.15, (2.2 - time_s) / 0.15);
        1.7 * rise.min(fall).clamp(0.0, 1.0)
    };
    (0..SAMPLES)
        .map(|sample| {
            let time_s = f64::from(sample) * SAMPLE_S % 6.0;
            Currents {
                lift_a: (pulse(time_s) + noise_a()).max(0.0),
                lower_a: (pulse(time_s - 3.0) + noise_a()).max(0.0),
            }
        })
        .collect()
}

fn main() {
    let mut arguments = std::env::args().skip(1);
    let chosen = arguments.next();
    let repeats = arguments.next().and_then(|text| text.parse().ok());
    let repeats: u32 = repeats.unwrap_or(200);
    let rig = Rig::Hitch(HitchRig {
        load_kg: 150.0,
        start_angle_rad: 1.4,
    });
    let currents = currents();
    let time_s: Vec<f64> = (0..SAMPLES).map(|k| f64::from(k) * SAMPLE_S).collect();
    let plant_s = f64::from(SAMPLES - 1) * SAMPLE_S;
    for (name, dynamics, effects) in CASES {
        if chosen.as_ref().is_some_and(|chosen| chosen != name) {
            continue;
        }
        let model = model(*dynamics, effects);
        let step_s = match dynamics {
            Dynamics::Steady => SAMPLE_S,
            Dynamics::Dynamic => 0.004,
        };
        // The fastest run is the one least disturbed by other programs.
        let mut fastest_s = f64::INFINITY;
        for _ in 0..repeats {
            let start = Instant::now();
            black_box(simulate(&model, rig, 40.0, &time_s, black_box(&currents)));
            fastest_s = fastest_s.min(start.elapsed().as_secs_f64());
        }
        let steps = plant_s / step_s;
        println!(
            "{name}: {:.1} ns per step, {:.0} s of plant time per s; {steps:.0} steps a run, {repeats} runs",
            1e9 * fastest_s / steps,
            plant_s / fastest_s,
        );
    }
}
