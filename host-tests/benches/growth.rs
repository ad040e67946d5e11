//! Growth of `explain` with the size of a campaign: time and peak memory over runs, sample rate and candidate effects.
//!
//! ```text
//! cargo bench -p host-tests --bench growth
//! cargo bench -p host-tests --bench growth -- --family dynamic --runs 5,20,80 --rates 50 --candidates 60
//! ```
//!
//! The campaigns are lab plans simulated with the project's plant, with Coulomb friction hidden in it. Terms of the
//! model's own, which differ in place and formula, make up the number of candidate effects. Each case is a process of
//! its own, so that its peak memory is its own. Exponents are slopes of the logarithms from row to row. Peak memory is
//! that of Linux (`VmHWM`).

use std::process::Command;
use std::time::Instant;

use anyhow::{Context, Result, bail, ensure};
use clap::Parser;
use hitch_effects::TermEffect;
use hitch_effects::expression::{ParameterDefinition, TermDefinition};
use hitch_identification::data::experiment::Experiment;
use hitch_identification::data::problem::Problem;
use hitch_identification::explanation::explain::explain;
use hitch_plant::{AddedEffect, Dynamics, Effect, Model, Place};
use host_tests::markdown::table;
use rand::SeedableRng;
use rand_pcg::Pcg64;
use truth_rigs::hidden_effects::starting_point;
use truth_rigs::second_rig::test_stand::Family;
use truth_rigs::simulated_lab::campaign_of;

/// Seed of all campaigns.
const SEED: u64 = 1;

/// How do time and memory of `explain` grow?
#[derive(Debug, Parser)]
struct Arguments {
    /// Plant of the rig and of the model
    #[arg(long, value_enum, default_value = "steady")]
    family: Family,
    /// Numbers of runs, at the first rate and number of candidates
    #[arg(long, value_delimiter = ',', default_value = "20,5,50,100,200")]
    runs: Vec<usize>,
    /// Sample rates, Hz, at the first number of runs and of candidates
    #[arg(long, value_delimiter = ',', default_value = "50,100,200,500,1000")]
    rates: Vec<f64>,
    /// Numbers of candidate effects, at the first number of runs and rate
    #[arg(long, value_delimiter = ',', default_value = "50,75,100")]
    candidates: Vec<usize>,
    /// Only the case of the first of each, in this process: its time, s, and peak memory, MB
    #[arg(long)]
    once: bool,
    /// Given by cargo
    #[arg(long, hide = true)]
    bench: bool,
}

/// A campaign and its candidates.
#[derive(Debug, Clone, Copy)]
struct Case {
    family: Family,
    runs: usize,
    rate_hz: f64,
    candidates: usize,
}

/// What a case takes.
#[derive(Debug, Clone, Copy)]
struct Taken {
    time_s: f64,
    memory_mb: f64,
}

/// Formulas of the terms: courses over the piston's travel, which is about 0.2 m.
fn formula(number: usize) -> String {
    let waves = 1 + number / 2;
    let way = if number.is_multiple_of(2) {
        "sin"
    } else {
        "cos"
    };
    format!("c * {way}({waves} * x / 50[mm])")
}

fn main() -> Result<()> {
    let arguments = Arguments::parse();
    let first = Case {
        family: arguments.family,
        runs: *arguments.runs.first().context("no number of runs")?,
        rate_hz: *arguments.rates.first().context("no rate")?,
        candidates: *arguments.candidates.first().context("no candidates")?,
    };
    if arguments.once {
        let taken = first.measure()?;
        println!("{} {}", taken.time_s, taken.memory_mb);
        return Ok(());
    }
    let runs = arguments
        .runs
        .iter()
        .map(|&runs| (runs as f64, Case { runs, ..first }));
    print("runs", runs.collect())?;
    let rates = arguments
        .rates
        .iter()
        .map(|&rate_hz| (rate_hz, Case { rate_hz, ..first }));
    print("sample rate, Hz", rates.collect())?;
    let candidates = arguments.candidates.iter();
    let candidates = candidates.map(|&candidates| {
        (
            candidates as f64,
            Case {
                candidates,
                ..first
            },
        )
    });
    print("candidate effects", candidates.collect())
}

/// Measures and prints a series of cases by increasing size.
fn print(what: &str, mut cases: Vec<(f64, Case)>) -> Result<()> {
    cases.sort_by(|a, b| a.0.total_cmp(&b.0));
    let header = [what, "time, s", "exponent", "peak memory, MB", "exponent"];
    let mut rows = Vec::new();
    let mut last: Option<(f64, Taken)> = None;
    for (size, case) in cases {
        let taken = case.in_a_process()?;
        let exponent = |of: fn(&Taken) -> f64| {
            last.as_ref().map_or(String::new(), |(smaller, before)| {
                format!(
                    "{:.2}",
                    (of(&taken) / of(before)).ln() / (size / smaller).ln()
                )
            })
        };
        rows.push([
            size.to_string(),
            format!("{:.2}", taken.time_s),
            exponent(|taken| taken.time_s),
            format!("{:.0}", taken.memory_mb),
            exponent(|taken| taken.memory_mb),
        ]);
        last = Some((size, taken));
    }
    println!("{}\n", table(header, &rows));
    Ok(())
}

impl Case {
    /// What the case takes in a process of its own.
    fn in_a_process(self) -> Result<Taken> {
        let family = match self.family {
            Family::Steady => "steady",
            Family::Dynamic => "dynamic",
        };
        let output = Command::new(std::env::current_exe()?)
            .args(["--once", "--family", family])
            .args(["--runs", &self.runs.to_string()])
            .args(["--rates", &self.rate_hz.to_string()])
            .args(["--candidates", &self.candidates.to_string()])
            .output()?;
        let errors = String::from_utf8_lossy(&output.stderr);
        ensure!(
            output.status.success(),
            "{self:?} ends with an error: {errors}"
        );
        let text = String::from_utf8(output.stdout)?;
        let numbers: Vec<f64> = text
            .split_whitespace()
            .map(str::parse)
            .collect::<Result<_, _>>()?;
        let [time_s, memory_mb] = numbers[..] else {
            bail!("{self:?} prints {text}");
        };
        Ok(Taken { time_s, memory_mb })
    }

    /// What the case takes in this process.
    fn measure(self) -> Result<Taken> {
        let model = starting_point(self.family);
        let friction = hitch_effects::find("coulomb-friction").context("no such effect")?;
        let rig = model.with_effects(vec![AddedEffect::typical(friction)]);
        let mut random = Pcg64::seed_from_u64(SEED);
        let campaign = campaign_of(&rig, self.runs, self.rate_hz, &mut random);
        let model = model.with_terms(self.terms(&model)?);
        let started = Instant::now();
        let experiment = Experiment::new(&campaign, &model);
        let explanation = explain(Problem::new(&experiment, &model), &|_| {});
        let time_s = started.elapsed().as_secs_f64();
        std::hint::black_box(explanation);
        let memory_mb = peak_memory_mb()?;
        Ok(Taken { time_s, memory_mb })
    }

    /// Terms that make up the number of candidates.
    fn terms(self, model: &Model) -> Result<Vec<&'static dyn Effect>> {
        let possible = hitch_effects::available(model)
            .into_iter()
            .filter(|effect| {
                let needed = effect.needs();
                needed.is_none_or(|needed: Dynamics| needed == model.constants().dynamics)
            });
        let known = possible.count();
        let more = self.candidates.checked_sub(known);
        let more = more.with_context(|| format!("the catalogue has {known} candidates already"))?;
        let terms = (0..more).map(|number| {
            let places = [Place::LiftFlowFactor, Place::LowerFlowFactor];
            let definition = TermDefinition {
                id: format!("term-{number}"),
                title: String::new(),
                place: places[number % 2],
                formula: formula(number / 2),
                parameters: vec![ParameterDefinition {
                    name: "c".to_owned(),
                    unit: String::new(),
                    meaning: String::new(),
                    null: 0.0,
                    start: 0.1,
                    low: -0.5,
                    high: 0.5,
                }],
            };
            let term: &'static dyn Effect = TermEffect::define(definition)?;
            Ok(term)
        });
        terms.collect()
    }
}

/// Largest resident memory of this process so far, MB.
fn peak_memory_mb() -> Result<f64> {
    let status = std::fs::read_to_string("/proc/self/status").context("no /proc of Linux")?;
    let mut lines = status.lines();
    let peak = lines.find_map(|line| line.strip_prefix("VmHWM:"));
    let kib = peak.and_then(|rest| rest.split_whitespace().next());
    Ok(kib
        .context("no peak memory in /proc/self/status")?
        .parse::<f64>()?
        * 1024.0
        / 1e6)
}
