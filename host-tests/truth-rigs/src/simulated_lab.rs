//! A lab campaign simulated with the project's own plant, so that the parameters of its effects have the meaning of the
//! catalogue. Currents vary between samples, loads have weighing errors, instruments have noise and finite resolution.

use hitch_campaign::{Bench, Campaign, Run};
use hitch_plant::simulation::simulate;
use hitch_plant::{Channel, Currents, Model};
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;

use crate::second_rig::campaign_writer::LOAD_SIGMA;
use crate::second_rig::instruments::{Instruments, stated_noise};
use crate::second_rig::manoeuvres::{Manoeuvre, Plan, runs};
use crate::second_rig::test_stand::SAMPLE_RATE_HZ;

/// Steps of the truth from one sample to the next.
const FINER: usize = 5;

/// The second rig's plan of a lab campaign, driven on `rig`.
#[must_use]
pub fn campaign(rig: &Model, random: &mut Pcg64) -> Campaign {
    let manoeuvres = runs(Plan::Lab, random);
    logged(rig, &manoeuvres, SAMPLE_RATE_HZ, random)
}

/// `count` runs of that plan, spread evenly over it and repeated as needed, logged at a rate, Hz.
#[must_use]
pub fn campaign_of(rig: &Model, count: usize, rate_hz: f64, random: &mut Pcg64) -> Campaign {
    let plan = runs(Plan::Lab, random);
    let stride = plan.len().div_ceil(count.max(1));
    let repeated = plan.iter().step_by(stride).chain(plan.iter().cycle());
    let manoeuvres: Vec<Manoeuvre> = repeated.take(count).cloned().collect();
    logged(rig, &manoeuvres, rate_hz, random)
}

fn logged(rig: &Model, manoeuvres: &[Manoeuvre], rate_hz: f64, random: &mut Pcg64) -> Campaign {
    let instruments = Instruments::good();
    Campaign {
        name: "simulated".to_owned(),
        description: String::new(),
        sample_rate_hz: rate_hz,
        synchronous: false,
        noise: stated_noise(instruments.current_sigma_a),
        runs: manoeuvres
            .iter()
            .map(|manoeuvre| log(rig, manoeuvre, rate_hz, &instruments, random))
            .collect(),
    }
}

fn log(
    rig: &Model,
    manoeuvre: &Manoeuvre,
    rate_hz: f64,
    instruments: &Instruments,
    random: &mut Pcg64,
) -> Run {
    let samples = (manoeuvre.duration_s * rate_hz).round() as usize;
    let fine_s: Vec<f64> = (0..=samples * FINER)
        .map(|step| step as f64 / (rate_hz * FINER as f64))
        .collect();
    let currents: Vec<Currents> = fine_s
        .iter()
        .map(|&time_s| Currents {
            lift_a: manoeuvre.lift.at(time_s),
            lower_a: manoeuvre.lower.at(time_s),
        })
        .collect();
    let error: f64 = StandardNormal.sample(random);
    let real = match manoeuvre.bench {
        Bench::Hitch { load_kg } => Bench::Hitch {
            load_kg: load_kg * (1.0 + LOAD_SIGMA * error),
        },
        bench @ Bench::Flow { .. } => bench,
    };
    let stand = real.rig(manoeuvre.start_deg.to_radians());
    let trace = simulate(rig, stand, manoeuvre.oil_temperature_c, &fine_s, &currents);
    let readings: Vec<[f64; 4]> = (0..=samples)
        .map(|sample| Channel::ALL.map(|channel| trace.channel(channel)[sample * FINER]))
        .collect();
    let logged = |current: fn(&Currents) -> f64, random: &mut Pcg64| {
        let truth: Vec<f64> = currents.iter().step_by(FINER).map(current).collect();
        instruments.log_current(&truth, random)
    };
    Run {
        file: manoeuvre.file.clone(),
        bench: manoeuvre.bench,
        oil_temperature_c: manoeuvre.oil_temperature_c,
        oil_temperature_known: true,
        time_s: fine_s.iter().copied().step_by(FINER).collect(),
        lift_current_a: logged(|currents| currents.lift_a, random),
        lower_current_a: logged(|currents| currents.lower_a, random),
        channels: std::array::from_fn(|channel| {
            instruments.log_channel(channel, &readings, random)
        }),
        oil_temperature_log_c: None,
    }
}
