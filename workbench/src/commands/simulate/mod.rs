//! `hitch simulate`: simulates the plant with the currents of logs.
mod folder;
mod trace;

use std::path::{Path, PathBuf};

use hitch_campaign::{Bench, Campaign, Run};
use hitch_plant::{Channel, Model};

use hitch_output::error::Error;
use hitch_output::progress::Progress;
use hitch_output::targets::Outputs;
use hitch_results::arguments::model::ModelArg;

use folder::Folder;
use trace::simulated;

/// Number of samples that are averaged for the start angle.
const START_SAMPLES: usize = 5;

/// Arguments of `hitch simulate`.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Examples:\n  hitch simulate --model dynamic --inputs lift_1.5A_050kg.csv --load 50 --out lift.csv\n  \
    hitch simulate monday --model dynamic --out simulated   # a campaign: each run at its load and oil temperature"
)]
pub struct Args {
    #[command(flatten)]
    model: ModelArg,
    /// Campaign whose runs are simulated, each at its load or port pressure and its oil temperature
    #[arg(value_name = "CAMPAIGN", required_unless_present = "inputs", conflicts_with_all = ["inputs", "load", "port_pressure", "start_angle", "oil_temperature"])]
    campaign: Option<PathBuf>,
    /// Logs with the columns time_s, lift_current_a and lower_current_a; others are optional
    #[arg(long, value_name = "RUN.csv", num_args = 1..)]
    inputs: Vec<PathBuf>,
    /// Write the result to this file, in the format of a log; `-` is standard output. For a campaign or several logs, a
    /// folder that becomes a campaign
    #[arg(long, value_name = "OUT")]
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
/// # Errors
/// If the model or a log is invalid, or the result cannot be written.
pub fn run(args: &Args) -> Result<(), Error> {
    match (&args.campaign, args.inputs.as_slice()) {
        (Some(campaign), _) => args.simulate_campaign(campaign),
        (None, [log]) => args.simulate_log(log),
        (None, logs) => args.simulate_logs(logs),
    }
}

impl Args {
    /// Simulates one log to a file.
    fn simulate_log(&self, path: &Path) -> Result<(), Error> {
        Outputs::check(
            [Some(self.out.as_path())],
            &[path.to_path_buf(), self.model.file()],
        )?;
        let model = self.model.load()?;
        let log = Run::read(path, self.bench(&model), self.oil_temperature)?;
        let progress = Progress::start(format!("simulating {}", log.file));
        let rig = log.bench.rig(self.start_angle_rad(&model, &log)?);
        let text = simulated(&model, rig, &log);
        drop(progress);
        hitch_output::write_file(&self.out, text.as_bytes())
    }

    /// Simulates several logs under the same conditions to a folder.
    fn simulate_logs(&self, paths: &[PathBuf]) -> Result<(), Error> {
        let mut folder = Folder::new(&self.out)?;
        let model = self.model.load()?;
        let bench = self.bench(&model);
        let read = |path: &PathBuf| Run::read(path, bench, self.oil_temperature);
        let runs: Result<Vec<Run>, _> = paths.iter().map(read).collect();
        self.simulate_runs(&mut folder, &model, &runs?)?;
        folder.finish(None)
    }

    /// Simulates the runs of a campaign to a folder.
    fn simulate_campaign(&self, path: &Path) -> Result<(), Error> {
        let mut folder = Folder::new(&self.out)?;
        let model = self.model.load()?;
        let campaign = Campaign::load_with(path, model.linkage())?;
        self.simulate_runs(&mut folder, &model, &campaign.runs)?;
        folder.finish(Some(&campaign))
    }

    /// Simulates runs in their order and adds them to a folder.
    fn simulate_runs(&self, folder: &mut Folder, model: &Model, runs: &[Run]) -> Result<(), Error> {
        let progress = Progress::start("simulating");
        for run in runs {
            progress.say(format!("simulating {}", run.file));
            let rig = run.bench.rig(self.start_angle_rad(model, run)?);
            folder.add(run, &simulated(model, rig, run))?;
        }
        Ok(())
    }

    fn bench(&self, model: &Model) -> Bench {
        match self.port_pressure {
            Some(port_pressure_bar) => Bench::Flow { port_pressure_bar },
            None => Bench::Hitch {
                load_kg: self.load.unwrap_or(model.usual_loads_kg()[1]),
            },
        }
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

/// Parses the number of an option and checks its range.
fn within<const LOW: i32, const HIGH: i32>(text: &str) -> Result<f64, String> {
    let number: f64 = text.parse().map_err(|_| "it is not a number".to_owned())?;
    if (f64::from(LOW)..=f64::from(HIGH)).contains(&number) {
        return Ok(number);
    }
    Err(format!("the range is {LOW} to {HIGH}"))
}
