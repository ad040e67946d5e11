//! Drives the controller with the calibration of an untaught machine on drawn hitches, and tabulates the motion.

use std::fmt::Write;
use std::path::PathBuf;

use anyhow::Context as _;
use clap::Parser;
use hitch_quantities::{Calibration, ValidCalibration};
use rayon::prelude::*;
use truth_rigs::drawn_hitches::draw::{Drawn, draw};
use truth_rigs::drawn_hitches::figures::{table, worst};
use truth_rigs::drawn_hitches::session::{MoveFigures, drive, drive_watched};
use truth_rigs::second_rig::physics::SpoolMotion;

/// Arguments.
#[derive(Parser)]
struct Arguments {
    /// How many machines
    #[arg(long, default_value_t = 60)]
    machines: u64,
    /// The first machine's seed
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// How many moves each, in one go from power-up
    #[arg(long, default_value_t = 6)]
    moves: usize,
    /// How many of the worst are shown by each figure
    #[arg(long, default_value_t = 5)]
    worst: usize,
    /// A calibration; without it, the one of an untaught machine
    #[arg(long)]
    calibration: Option<PathBuf>,
    /// Write every millisecond of the first machine as CSV, instead of any table
    #[arg(long, value_name = "TRACE.csv")]
    trace: Option<PathBuf>,
    /// Write the figures of every move as CSV, beside the tables
    #[arg(long, value_name = "MOVES.csv")]
    table: Option<PathBuf>,
    /// Only machines of this kind
    #[arg(long, value_enum)]
    only: Option<Kind>,
    /// Give each machine second-order spools instead of its own: natural frequency in rad/s, damping, dead time in ms
    #[arg(long, value_name = "FREQUENCY,DAMPING,DEAD", value_parser = second_order)]
    spool: Option<SpoolMotion>,
    /// Another value in it, as in `hitch loop --set`
    #[arg(long, value_name = "GROUP.NAME=VALUE")]
    set: Vec<String>,
}

/// A kind of machine.
#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Kind {
    /// Effects are what textbooks say.
    Textbook,
    /// They have more structure than that.
    Structured,
}

fn main() -> anyhow::Result<()> {
    let arguments = Arguments::parse();
    let calibration = calibration(&arguments)?;
    let machines: Vec<Drawn> = (arguments.seed..arguments.seed + arguments.machines)
        .map(|seed| {
            let drawn = draw(seed, arguments.moves);
            match arguments.spool {
                Some(motion) => drawn.with_spool(motion),
                None => drawn,
            }
        })
        .filter(|drawn| {
            arguments
                .only
                .is_none_or(|kind| drawn.structured == (kind == Kind::Structured))
        })
        .collect();
    if let Some(path) = &arguments.trace {
        let drawn = machines.first().context("no machine of this kind")?;
        return Ok(std::fs::write(path, trace(drawn, &calibration))?);
    }
    let moves: Vec<MoveFigures> = machines
        .par_iter()
        .flat_map_iter(|drawn| drive(drawn, &calibration))
        .collect();
    if let Some(path) = &arguments.table {
        std::fs::write(path, csv(&moves))?;
    }
    let print = |title: &str, chosen: fn(&MoveFigures) -> bool| {
        let group: Vec<&MoveFigures> = moves.iter().filter(|moved| chosen(moved)).collect();
        if !group.is_empty() {
            println!("{}", table(title, &group));
        }
    };
    print("all", |_| true);
    print("textbook machines", |moved| !moved.structured);
    print("structured machines", |moved| moved.structured);
    print("first after power-up", |moved| moved.index == 0);
    print("later", |moved| moved.index > 0);
    print("lifting", |moved| moved.to_deg > moved.from_deg);
    print("lowering", |moved| moved.to_deg < moved.from_deg);
    print("up to 5 degrees", |moved| {
        (moved.to_deg - moved.from_deg).abs() < 5.0
    });
    println!("{}", worst(&moves, &machines, arguments.worst));
    Ok(())
}

/// `FREQUENCY,DAMPING,DEAD` of a spool.
fn second_order(text: &str) -> anyhow::Result<SpoolMotion> {
    let numbers: Vec<f64> = text.split(',').map(str::parse).collect::<Result<_, _>>()?;
    let [frequency_rad_s, damping, dead_time_ms] = numbers[..] else {
        anyhow::bail!("three numbers make a spool");
    };
    Ok(SpoolMotion::Swinging {
        frequency_rad_s,
        damping,
        dead_time_s: dead_time_ms * 1e-3,
    })
}

/// A line a move.
fn csv(moves: &[MoveFigures]) -> String {
    let mut text = "seed,structured,move,from_deg,to_deg,time_s,shortest_s,ratio,overshoot_deg,final_error_deg,swing_ratio,switched_on_after\n"
        .to_owned();
    for moved in moves {
        let _ = writeln!(
            text,
            "{},{},{},{:.3},{:.3},{:.3},{:.3},{:.4},{:.4},{:.4},{:.3},{}",
            moved.seed,
            moved.structured,
            moved.index,
            moved.from_deg,
            moved.to_deg,
            moved.time_s,
            moved.shortest_s,
            moved.ratio,
            moved.overshoot_deg,
            moved.final_error_deg,
            moved.swing_ratio,
            moved.switched_on_after,
        );
    }
    text
}

/// One line per millisecond: state of the hitch, and estimates and outputs of the controller.
fn trace(drawn: &Drawn, calibration: &ValidCalibration) -> String {
    let mut text = "time_s,lever_deg,rocker_deg,cylinder_bar,lift_a,lower_a,estimated_mm,estimated_mm_s,demanded_mm_s\n"
        .to_owned();
    let mut step = 0;
    drive_watched(drawn, calibration, |lever_deg, instant| {
        let [lift_a, lower_a] = instant.currents_a;
        let [estimated_mm_s, demanded_mm_s] = instant.speeds_mm_s;
        let _ = writeln!(
            text,
            "{:.3},{lever_deg:.3},{:.4},{:.3},{lift_a:.3},{lower_a:.3},{:.4},{estimated_mm_s:.2},{demanded_mm_s:.2}",
            f64::from(step) * 1e-3,
            instant.rocker_deg,
            instant.cylinder_bar,
            instant.estimated_mm,
        );
        step += 1;
    });
    text
}

fn calibration(arguments: &Arguments) -> anyhow::Result<ValidCalibration> {
    let mut calibration = match &arguments.calibration {
        Some(path) => (*hitch_controller_host::calibration_file::read(path)?).clone(),
        None => Calibration::nominal(),
    };
    for setting in &arguments.set {
        hitch_controller_host::calibration_file::set(&mut calibration, setting)
            .map_err(anyhow::Error::msg)?;
    }
    calibration
        .sealed()
        .validate()
        .map_err(|error| anyhow::anyhow!("{error:?}"))
}
