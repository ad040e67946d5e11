//! Run times: simulation of each kind of run with each plant, and explanation of complete campaigns.
//!
//! The simulated runs are those of the demonstration, at the sample rate of its logger (50 Hz). The explained ones are
//! lab campaigns of twenty runs; the limit is 10 s on two cores.

use std::hint::black_box;
use std::path::Path;
use std::time::Instant;

use hitch_campaign::Campaign;
use hitch_identification::data::clocks::Clocks;
use hitch_identification::data::experiment::Experiment;
use hitch_identification::data::nuisance::CurrentShift;
use hitch_identification::data::nuisance::Nuisance;
use hitch_identification::data::problem::Problem;
use hitch_identification::data::ready_run::ReadyRun;
use hitch_identification::explanation::explain::explain;
use hitch_plant::{AddedEffect, Channel};
use hitch_results::arguments::demonstration;
use rand::SeedableRng;
use rand_distr::{Distribution, Normal};
use rand_pcg::Pcg64;

fn measured() -> Campaign {
    demonstration::campaign().expect("the demonstration is built in")
}

/// A lab campaign of the host tests.
fn lab(name: &str) -> Campaign {
    let campaigns = Path::new(env!("CARGO_MANIFEST_DIR")).join("campaigns");
    Campaign::load(&campaigns.join(name)).expect("a shipped campaign")
}

/// A lab campaign measured on a rig that is the dynamic plant with Coulomb friction: the currents and instruments of a
/// measured one, always the same noise.
fn measured_on_a_dynamic_rig() -> Campaign {
    let friction = hitch_effects::find("coulomb-friction").expect("the effect is in the catalogue");
    let rig = hitch_model_file::dynamic().with_effects(vec![AddedEffect::typical(friction)]);
    let mut campaign = lab("clean-dynamic");
    let experiment = Experiment::new(&campaign, &rig);
    let mut random = Pcg64::seed_from_u64(1);
    for (run, ready) in campaign.runs.iter_mut().zip(&experiment.runs) {
        let trace = ready.simulate(&rig, Nuisance::default(), &Clocks::default());
        for channel in Channel::ALL {
            let sigma = experiment.noise[channel.index()];
            if let Some(values) = &mut run.channels[channel.index()] {
                let noise = Normal::new(0.0, sigma).expect("an instrument has noise");
                *values = trace
                    .channel(channel)
                    .iter()
                    .map(|value| value + noise.sample(&mut random))
                    .collect();
            }
        }
    }
    campaign
}

/// Repetitions of a measured task.
const REPETITIONS: usize = 11;

/// Runs a task several times; prints the smallest, median and largest time, and the samples that the median has in a second.
fn measure(name: &str, samples: Option<usize>, task: impl Fn()) {
    let mut seconds: Vec<f64> = (0..REPETITIONS)
        .map(|_| {
            let started = Instant::now();
            task();
            started.elapsed().as_secs_f64()
        })
        .collect();
    seconds.sort_by(f64::total_cmp);
    let [least, median, most] =
        [0, REPETITIONS / 2, REPETITIONS - 1].map(|rank| 1e3 * seconds[rank]);
    println!("{name}\n  time: {least:.2} ms, {median:.2} ms, {most:.2} ms");
    if let Some(samples) = samples {
        println!(
            "  throughput: {:.2} million samples/s",
            samples as f64 / median / 1e3
        );
    }
}

fn simulate_runs() {
    let campaign = measured();
    for model in [hitch_model_file::nominal(), hitch_model_file::dynamic()] {
        let experiment = Experiment::new(&campaign, &model);
        for (kind, on_hitch) in [("hitch", true), ("flow-bench", false)] {
            let runs: Vec<&ReadyRun> = experiment
                .runs
                .iter()
                .filter(|run| run.on_hitch() == on_hitch)
                .collect();
            let samples = runs.iter().map(|run| run.len()).sum();
            let name = format!("simulate {kind} runs/{}", model.name);
            measure(&name, Some(samples), || {
                for run in &runs {
                    let shift = CurrentShift::default();
                    black_box(run.simulated(&model, Nuisance::default(), shift));
                }
            });
        }
    }
}

fn explain_campaigns() {
    for (campaign, model) in [
        (lab("known-friction"), hitch_model_file::nominal()),
        (measured_on_a_dynamic_rig(), hitch_model_file::dynamic()),
    ] {
        measure(&format!("explain/{}", model.name), None, || {
            let experiment = Experiment::new(&campaign, &model);
            black_box(explain(Problem::new(&experiment, &model), &|_| {}));
        });
    }
}

fn main() {
    let selected = std::env::args().nth(1).unwrap_or_default();
    if "simulate".contains(&selected) || selected.starts_with("--") {
        simulate_runs();
    }
    if "explain".contains(&selected) || selected.starts_with("--") {
        explain_campaigns();
    }
}
