//! Measures a drawn case: as a campaign in memory, or as a folder.

use std::fmt::Write as _;
use std::path::Path;

use anyhow::{Context, Result};
use hitch_campaign::{Bench, Campaign, Run};
use hitch_plant::Channel;
use rand::{Rng, SeedableRng};
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;
use serde_json::{Map, Value, json};

use super::draw::Case;
use super::instruments::stated_noise;
use super::manoeuvres::{Course, Manoeuvre, Plan, runs};
use super::physics::Physics;
use super::test_stand::{Circumstances, Family, Reading, SAMPLE_RATE_HZ, measure};

/// Relative error of a weighed load on a rough campaign.
pub const LOAD_SIGMA: f64 = 0.005;

/// Pause between two runs, s.
const PAUSE_S: f64 = 20.0;

/// The noise streams of a campaign are separate from that of the case.
const NOISE_STREAM: u64 = 0x006e_6f69_7365;

/// A run of a case with all that was drawn for it.
#[derive(Debug, Clone)]
pub struct PlannedRun {
    /// Manoeuvres.
    pub manoeuvre: Manoeuvre,
    /// When, and with how wrong a weight.
    pub circumstances: Circumstances,
}

/// The runs of a case, in order.
#[must_use]
pub fn planned_runs(case: &Case) -> Vec<PlannedRun> {
    let mut random = Pcg64::seed_from_u64(case.seed ^ NOISE_STREAM);
    let mut since_s = 0.0;
    runs(case.plan, &mut random)
        .into_iter()
        .map(|manoeuvre| {
            let error: f64 = StandardNormal.sample(&mut random);
            let sigma = if case.rough { LOAD_SIGMA } else { 0.0 };
            let circumstances = Circumstances {
                since_s,
                load_factor: 1.0 + sigma * error,
            };
            since_s += manoeuvre.duration_s + PAUSE_S;
            PlannedRun {
                manoeuvre,
                circumstances,
            }
        })
        .collect()
}

/// Perfect readings of a case's runs with some other physics.
#[must_use]
pub fn perfect_readings(case: &Case, runs: &[PlannedRun], physics: &Physics) -> Vec<Vec<Reading>> {
    runs.iter()
        .map(|run| measure(physics, case.family, &run.manoeuvre, run.circumstances))
        .collect()
}

/// Measures a case.
#[must_use]
pub fn campaign(case: &Case) -> Campaign {
    let mut random = Pcg64::seed_from_u64(case.seed.wrapping_mul(3) ^ NOISE_STREAM);
    let physics = case.physics();
    let runs = planned_runs(case)
        .into_iter()
        .map(|run| log(case, &physics, &run, &mut random))
        .collect();
    let current_sigma_a = (case.instruments.current_sigma_a * 1e4).round() * 1e-4;
    Campaign {
        name: format!("drawn-{}", case.seed),
        description: "Hitch test bench campaign".to_owned(),
        sample_rate_hz: SAMPLE_RATE_HZ,
        synchronous: false,
        noise: stated_noise(current_sigma_a),
        runs,
    }
}

/// The log of one run.
pub fn log(case: &Case, physics: &Physics, run: &PlannedRun, random: &mut impl Rng) -> Run {
    let manoeuvre = &run.manoeuvre;
    let readings = measure(physics, case.family, manoeuvre, run.circumstances);
    let time_s: Vec<f64> = (0..readings.len())
        .map(|sample| sample as f64 * 2.0 / 100.0)
        .collect();
    let current = |course: &Course, random: &mut _| {
        let truth: Vec<f64> = time_s.iter().map(|&time_s| course.at(time_s)).collect();
        case.instruments.log_current(&truth, random)
    };
    let lift_current_a = current(&manoeuvre.lift, random);
    let lower_current_a = current(&manoeuvre.lower, random);
    let channels =
        std::array::from_fn(|channel| case.instruments.log_channel(channel, &readings, random));
    Run {
        file: manoeuvre.file.clone(),
        bench: manoeuvre.bench,
        oil_temperature_c: manoeuvre.oil_temperature_c,
        oil_temperature_known: true,
        time_s,
        lift_current_a,
        lower_current_a,
        channels,
        oil_temperature_log_c: None,
    }
}

/// The hidden effects of a case, as JSON.
#[must_use]
pub fn truth(case: &Case) -> Value {
    let hidden: Map<String, Value> = case
        .hidden
        .iter()
        .map(|hidden| (hidden.what.id.to_owned(), json!(hidden.size)))
        .collect();
    json!({
        "family": match case.family { Family::Steady => "steady", Family::Dynamic => "dynamic" },
        "plan": match case.plan { Plan::Lab => "lab", Plan::Field => "field" },
        "seed": case.seed,
        "rough": case.rough,
        "fidelity": format!("{:?}", case.fidelity).to_lowercase(),
        "kind": format!("{:?}", case.kind).to_lowercase(),
        "hidden": hidden,
    })
}

/// Writes a campaign to a folder, and the truth beside it as `FOLDER.truth.json`.
///
/// # Errors
/// When the folder or a file can't be written.
pub fn write(case: &Case, folder: &Path) -> Result<()> {
    let campaign = campaign(case);
    std::fs::create_dir_all(folder).with_context(|| format!("can't make {}", folder.display()))?;
    let put = |path: &Path, text: String| {
        std::fs::write(path, text).with_context(|| format!("can't write {}", path.display()))
    };
    for run in &campaign.runs {
        put(&folder.join(&run.file), csv(run))?;
    }
    put(&folder.join("campaign.toml"), manifest(&campaign))?;
    let mut beside = folder.as_os_str().to_owned();
    beside.push(".truth.json");
    put(Path::new(&beside), format!("{:#}\n", truth(case)))
}

fn manifest(campaign: &Campaign) -> String {
    let mut text = format!(
        "format = 1\nname = \"{}\"\ndescription = \"{}\"\nsample_rate_hz = {}\n\n[noise]\n",
        campaign.name, campaign.description, campaign.sample_rate_hz
    );
    let sigma = |value: Option<f64>| value.unwrap_or_default();
    let noise = &campaign.noise;
    // Writing to a string cannot fail.
    let _ = writeln!(text, "lift_current_a = {}", sigma(noise.lift_current_a));
    let _ = writeln!(text, "lower_current_a = {}", sigma(noise.lower_current_a));
    for channel in Channel::ALL {
        let _ = writeln!(text, "{} = {}", channel.key(), sigma(noise.of(channel)));
    }
    for run in &campaign.runs {
        let stand = match run.bench {
            Bench::Hitch { load_kg } => format!("bench = \"hitch\"\nload_kg = {load_kg}"),
            Bench::Flow { port_pressure_bar } => {
                format!("bench = \"flow\"\nport_pressure_bar = {port_pressure_bar}")
            }
        };
        let _ = write!(
            text,
            "\n[[run]]\nfile = \"{}\"\n{stand}\noil_temperature_c = {:.1}\n",
            run.file, run.oil_temperature_c
        );
    }
    text
}

fn csv(run: &Run) -> String {
    let logged: Vec<Channel> = Channel::ALL
        .into_iter()
        .filter(|channel| run.channel(*channel).is_some())
        .collect();
    let mut text = "time_s,lift_current_a,lower_current_a".to_owned();
    for channel in &logged {
        let _ = write!(text, ",{}", channel.key());
    }
    text.push('\n');
    for sample in 0..run.time_s.len() {
        let _ = write!(
            text,
            "{:.2},{:.3},{:.3}",
            run.time_s[sample], run.lift_current_a[sample], run.lower_current_a[sample]
        );
        for channel in &logged {
            let value = run
                .channel(*channel)
                .map_or(f64::NAN, |values| values[sample]);
            text.push(',');
            if value.is_finite() {
                let _ = write!(text, "{value:.2}");
            }
        }
        text.push('\n');
    }
    text
}
