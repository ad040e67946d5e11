//! Feeds the same steps to controller and envelope of an earlier commit and of the present one: `paired-replay --help`.

use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

use anyhow::{Context, Result};
use arm_build::workspace;
use clap::Parser;
use paired_replay::differences::{Differences, SECTION};
use paired_replay::interface::Layout;
use paired_replay::side::{Program, Side};
use paired_replay::{Reached, Replay, random, recorded, sources};

/// Page that explains differences.
const PAGE: &str = "docs/safety.md";

/// Feeds the same random and recorded steps to controller and safety envelope of an earlier commit and of the present
/// sources, and lists every difference. Exit code 1 if the safety page does not explain all of them.
#[derive(Debug, Parser)]
struct Arguments {
    /// The earlier commit.
    #[arg(long, value_name = "COMMIT", default_value = "HEAD")]
    against: String,
    /// Random steps of controller and envelope.
    #[arg(long, value_name = "N", default_value_t = 10_000_000)]
    steps: u64,
    /// Seed of the random steps; another one each time if it is missing.
    #[arg(long, value_name = "SEED")]
    seed: Option<u64>,
    /// Folder for the sources and programs of the sides.
    #[arg(long, value_name = "FOLDER")]
    folder: PathBuf,
}

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("paired-replay: {error:#}");
            ExitCode::from(2)
        }
    }
}

/// Whether there is no difference, or each is explained.
fn run(arguments: &Arguments) -> Result<bool> {
    let commit = sources::commit(&arguments.against)?;
    let earlier = sources::build_commit(&commit, &arguments.folder)?;
    let present = sources::build(&workspace::root(), &arguments.folder.join("present"))?;
    let start = || -> Result<(Program, Program)> {
        Ok((
            Program::start(&commit, &earlier)?,
            Program::start("the present sources", &present)?,
        ))
    };

    let (mut one, mut other) = start()?;
    for line in Layout::of(one.interface(), other.interface())?.alone {
        println!("{line}");
    }
    let replay = recorded(&mut one, &mut other)?;
    println!("recorded closed loop: {}", described(&replay.reached));
    let mut differences = replay.differences;

    let (mut one, mut other) = start()?;
    let seed = arguments.seed.unwrap_or_else(|| fastrand::u64(..));
    println!("random steps with --seed {seed}");
    let started = Instant::now();
    let Replay {
        differences: found,
        reached,
    } = random(&mut one, &mut other, seed, arguments.steps)?;
    let seconds = started.elapsed().as_secs_f64();
    println!("random: {}", described(&reached));
    println!(
        "{seconds:.0} s, {:.0} steps per second",
        reached.steps as f64 / seconds
    );
    differences.merge(found);

    let page =
        std::fs::read_to_string(workspace::root().join(PAGE)).with_context(|| PAGE.to_owned())?;
    Ok(report(&differences, &page, &commit))
}

fn described(reached: &Reached) -> String {
    format!(
        "{} steps, {} with a coil on, {} accepted values of the calibration, trips {:?}, states {:?}",
        reached.steps,
        reached.moving,
        reached.calibrations,
        Reached::codes(reached.trips),
        Reached::codes(reached.states)
    )
}

/// Prints the differences; true if the page explains all of them.
fn report(differences: &Differences, page: &str, commit: &str) -> bool {
    let unexplained = differences.unexplained(page, commit);
    for (names, group) in &differences.groups {
        let is_unexplained = unexplained.contains(&names.as_str());
        let what = if is_unexplained {
            "not explained"
        } else {
            "explained"
        };
        println!(
            "\n{} times, {what}: `{names}`\n{}",
            group.count, group.first
        );
    }
    if differences.groups.is_empty() {
        println!("no difference to {commit}");
    }
    if !unexplained.is_empty() {
        println!(
            "{} kinds of differences to {commit} are not explained: find the cause of each, and add a line with \
             commit, outputs and cause below `{SECTION}` in {PAGE}",
            unexplained.len()
        );
    }
    unexplained.is_empty()
}
