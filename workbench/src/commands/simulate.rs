//! `hitch simulate`: simulates the plant with the currents of a log.

use std::fmt::Write as _;
use std::path::PathBuf;

use hitch_campaign::{Bench, Run};
use hitch_plant::units::pa_from_bar;
use hitch_plant::{Channel, Currents, HitchRig, Model, Plant, Reading, Rig};

use crate::error::Error;
use crate::model_arg::ModelArg;
use crate::output;
use crate::outputs::Outputs;
use crate::progress::Progress;

/// Number of samples that are averaged for the start angle.
const START_SAMPLES: usize = 5;

/// Arguments of `hitch simulate`.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Example: hitch simulate --model dynamic --inputs lift_1.5A_050kg.csv --load 50 --out lift.csv"
)]
pub struct Args {
    #[command(flatten)]
    model: ModelArg,
    /// Log with the columns time_s, lift_current_a and lower_current_a; others are optional
    #[arg(long, value_name = "RUN.csv")]
    inputs: PathBuf,
    /// Write the result to this file, in the format of a log; `-` is standard output
    #[arg(long, value_name = "OUT.csv")]
    out: PathBuf,
    /// Load at the hitch, kg; without this option, 9 % of what the model can lift, 150 for the paper's
    #[arg(long, value_name = "KG", allow_negative_numbers = true, value_parser = within::<0, 20_000>)]
    load: Option<f64>,
    /// Flow bench instead of the hitch: pressure at the cylinder port, bar
    #[arg(long, value_name = "BAR", allow_negative_numbers = true, conflicts_with_all = ["load", "start_angle"], value_parser = within::<0, 400>)]
    port_pressure: Option<f64>,
    /// Rocker angle at the start, degrees; without this option, from the log's first samples, else fully down
    #[arg(long, value_name = "DEG", allow_negative_numbers = true, value_parser = within::<0, 180>)]
    start_angle: Option<f64>,
    /// Oil temperature, degrees Celsius
    #[arg(long, value_name = "C", default_value_t = 40.0, allow_negative_numbers = true, value_parser = within::<-40, 150>)]
    oil_temperature: f64,
}

/// Runs the command.
///
/// If the model or the log is invalid, or the result cannot be written.
/// If the model or the log is wrong, or the result cannot be written.
pub fn run(args: &Args) -> Result<(), Error> {
    Outputs::check(
        [Some(args.out.as_path())],
        &[args.inputs.clone(), args.model.file()],
    )?;
    let model = args.model.load()?;
    let log = Run::read(&args.inputs, args.bench(&model), args.oil_temperature)?;
    let progress = Progress::start(format!("simulating {}", log.file));
    let rig = args.rig(&model, &log)?;
    let text = simulated(&model, rig, &log);
    drop(progress);
    output::write_file(&args.out, text.as_bytes())
}

impl Args {
    fn bench(&self, model: &Model) -> Bench {
        match self.port_pressure {
            Some(port_pressure_bar) => Bench::Flow { port_pressure_bar },
            None => Bench::Hitch {
                load_kg: self.load.unwrap_or(model.usual_loads_kg()[1]),
            },
        }
    }

    fn rig(&self, model: &Model, log: &Run) -> Result<Rig, Error> {
        Ok(match self.bench(model) {
            Bench::Flow { port_pressure_bar } => Rig::Flow {
                port_pressure_pa: pa_from_bar(port_pressure_bar),
            },
            Bench::Hitch { load_kg } => Rig::Hitch(HitchRig {
                load_kg,
                start_angle_rad: self.start_angle_rad(model, log)?,
            }),
        })
    }

    /// The start angle. A log's first samples may exceed the ends of travel by sensor noise.
    fn start_angle_rad(&self, model: &Model, log: &Run) -> Result<f64, Error> {
        /// Rounding of the ends of travel in the message, degrees.
        const ROUNDED_DEG: f64 = 0.05;
        let (low_rad, high_rad) = model.linkage().swing_rad();
        let (low_deg, high_deg) = (low_rad.to_degrees(), high_rad.to_degrees());
        if let Some(deg) = self.start_angle
            && !(low_deg - ROUNDED_DEG..=high_deg + ROUNDED_DEG).contains(&deg)
        {
            return Err(Error::Usage(format!(
                "--start-angle {deg}: the stroke goes from {low_deg:.1} to {high_deg:.1} degrees; \
                 name an angle between them"
            )));
        }
        let angle_deg = self.start_angle.or_else(|| logged_start_deg(log));
        Ok(angle_deg.map_or(low_rad, |deg| deg.to_radians().clamp(low_rad, high_rad)))
    }
}

fn logged_start_deg(log: &Run) -> Option<f64> {
    let known = log
        .channel(Channel::RockerAngle)?
        .iter()
        .filter(|deg| deg.is_finite());
    let first: Vec<f64> = known.take(START_SAMPLES).copied().collect();
    (!first.is_empty()).then(|| first.iter().sum::<f64>() / first.len() as f64)
}

/// The log with simulated instead of measured channels. (Writing to a string cannot fail.)
fn simulated(model: &Model, rig: Rig, log: &Run) -> String {
    let channels: Vec<Channel> = Channel::ALL
        .into_iter()
        .filter(|channel| can_show(rig, *channel))
        .collect();
    let keys: Vec<&str> = channels.iter().map(|channel| channel.key()).collect();
    let mut text = format!("time_s,lift_current_a,lower_current_a,{}\n", keys.join(","));
    let currents = |i: usize| Currents {
        lift_a: log.lift_current_a[i],
        lower_a: log.lower_current_a[i],
    };
    let mut plant = Plant::new(model, rig, log.oil_temperature_c, currents(0));
    for i in 0..log.time_s.len() {
        if i > 0 {
            plant.step(currents(i), log.time_s[i] - log.time_s[i - 1]);
        }
        let Currents { lift_a, lower_a } = currents(i);
        let _ = write!(text, "{},{lift_a},{lower_a}", log.time_s[i]);
        write_reading(&mut text, &plant.reading(), &channels);
    }
    text
}

fn write_reading(text: &mut String, reading: &Reading, channels: &[Channel]) {
    for channel in channels {
        let _ = write!(text, ",{:.5}", reading.channel(*channel) + 0.0);
    }
    text.push('\n');
}

fn can_show(rig: Rig, channel: Channel) -> bool {
    channel != Channel::RockerAngle || matches!(rig, Rig::Hitch(_))
}

/// Parses the number of an option and checks its range.
fn within<const LOW: i32, const HIGH: i32>(text: &str) -> Result<f64, String> {
    let number: f64 = text.parse().map_err(|_| "it is not a number".to_owned())?;
    if (f64::from(LOW)..=f64::from(HIGH)).contains(&number) {
        return Ok(number);
    }
    Err(format!("the range is {LOW} to {HIGH}"))
}
