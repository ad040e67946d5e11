//! `hitch tune`: tunes gains, ramps and limits for a plant.

use std::path::PathBuf;

use hitch_controller_host::calibration_file;
use hitch_plant::Model;
use hitch_quantities::Calibration;

use crate::commands::loop_::{changed, read_files};
use crate::commands::loop_scenario::LoopScenario;
use crate::commands::tune_field;
use crate::commands::tune_result::{Found, Search, Tuned};
use crate::commands::tune_scenario::{self, tunable};
use hitch_closed_loop::calibrate::calibrate;
use hitch_output::JsonArg;
use hitch_output::error::Error;
use hitch_output::progress::Progress;
use hitch_output::targets::Outputs;
use hitch_results::arguments::number::{LOADS_KG, number};
use hitch_results::closed_loop::{self, LoopRun, Move, Press, PressRun, Scenario, run_presses};
use hitch_results::report::tuning_page;
use hitch_results::tuning::{Judged, Trial};

/// Arguments of `hitch tune`.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Example: hitch tune --model explained.toml --out tuned.toml\n\n\
    The valve map is that of the model. The search varies ramps (position.lift_acceleration, lift_deceleration, \
    lower_acceleration, lower_deceleration), approach and cut-off (position.approach_gain, creep_speed, stop_band), \
    filters (motion.position_time, hydraulics.pressure_filter) and hydraulics.hysteresis (at least that of the model, \
    or 0.12 A without one). With the scenarios tuning and rate it also varies the button's ramp and trim (rate.rate_slope, \
    trim_time, trim_limit), and drives presses of the external button. Each candidate drives moves in both directions at three loads and temperatures, on the \
    model and on two neighbours with thresholds shifted by 0.02 A, and with typical hysteresis, friction, air and \
    cold oil where the model has none. The scenarios draft, mix, slip, depth and transport tune the function \
    instead (draft.work_filter, crossover, length, dead_band, step; slip.filter, slip_per_degree, crossover; ride.gain, low_corner, lead, forcing, \
    dead_band, centring_time) for the requirements of hitch loop --scenario; the figures are those on soils that the search has not seen. \
    Values given with --set are not changed. For manual tuning: hitch loop --set \
    position.approach_gain=30"
)]
pub struct Args {
    /// The plant: nominal, dynamic, or the name of a model file
    #[arg(long, value_name = "MODEL", default_value = "dynamic")]
    model: String,
    /// Write the calibration to this file
    #[arg(long, value_name = "C.toml")]
    out: PathBuf,
    /// Initial calibration; without this option, the nominal one with the model's valve map
    #[arg(long, value_name = "C.toml")]
    calibration: Option<PathBuf>,
    /// Set a value of the calibration, as in position.approach_gain=30, and keep it fixed; may be given several times
    #[arg(long, value_name = "GROUP.KEY=VALUE")]
    set: Vec<String>,
    /// Number of candidates
    #[arg(long, value_name = "COUNT", default_value_t = 400, value_parser = clap::value_parser!(u32).range(10..=100_000))]
    trials: u32,
    /// Moves to drive
    #[arg(long, value_parser = tunable(), default_value_t = LoopScenario::Moves(Scenario::Tuning))]
    scenario: LoopScenario,
    /// Loads at the hitch, kg; without this option, 3, 9 and 15 % of what the model can lift
    #[arg(long, value_name = "KG,KG", value_delimiter = ',', value_parser = number(LOADS_KG))]
    loads: Option<Vec<f64>>,
    #[command(flatten)]
    json: JsonArg,
    /// Write a report to this file: moves with both calibrations, changed values, figures
    #[arg(long, value_name = "FILE.html")]
    report: Option<PathBuf>,
    /// Write the calibration even if it is worse than the initial one
    #[arg(long)]
    force: bool,
}

/// Runs the command.
///
/// # Errors
/// If the model or the calibration is invalid, the result cannot be written, or it is worse than the initial calibration.
pub fn run(args: &Args) -> Result<(), Error> {
    let inputs = read_files(&args.model, args.calibration.as_ref());
    let wanted = [
        Some(args.out.as_path()),
        args.report.as_deref(),
        args.json.target(),
    ];
    let outputs = Outputs::check(wanted, &inputs)?;
    let model = hitch_model_file::named(&args.model)?;
    let base = match &args.calibration {
        Some(path) => calibration_file::read(path)?,
        None => calibrate(&model, &Calibration::nominal())
            .map_err(|error| Error::Usage(format!("{}: {error}", args.model)))?,
    };
    let base = changed(&base, &args.set)?;
    let fixed: Vec<String> = args
        .set
        .iter()
        .filter_map(|setting| calibration_file::set(&mut (*base).clone(), setting).ok())
        .collect();
    let search = Search {
        model: &model,
        base: &base,
        fixed: &fixed,
        trials: args.trials as usize,
    };
    let found = match args.scenario {
        LoopScenario::Field(_) if args.loads.is_some() => {
            return Err(Error::Usage(
                "scenarios of the field have their own loads: leave --loads out".to_owned(),
            ));
        }
        LoopScenario::Field(scenario) => tune_field::tuned(&search, scenario)?,
        _ => args.by_moves(&search)?,
    };
    let is_worse = found.tuned.is_worse();
    if !is_worse || args.force {
        let text = calibration_file::write_tuned(&found.calibration, &base);
        hitch_output::write_file(&args.out, text.as_bytes())?;
    }
    hitch_output::write_if(args.report.as_ref(), || found.page)?;
    outputs.tell(&args.json, &found.tuned, || found.tuned.to_string())?;
    if is_worse && !args.force {
        Err(worse(args, &found.tuned))
    } else {
        Ok(())
    }
}

impl Args {
    /// Tunes with moves of the lever and presses of the button.
    fn by_moves(&self, search: &Search<'_>) -> Result<Found, Error> {
        let (model, base) = (search.model, search.base);
        let progress = Progress::start("computing the ideal manoeuvres");
        let (scenario, loads_kg) = (self.scenario, self.loads.as_deref());
        let moves = tune_scenario::moves(scenario, model, loads_kg);
        let presses = tune_scenario::presses(scenario, model, base, loads_kg);
        let trial = Trial::new(model, &moves, &presses);
        let before = trial.judge(base).ok_or_else(Search::nothing)?;
        drop(progress);
        let after = search
            .told(|tell| trial.search(base, search.fixed, search.trials, tell))
            .ok_or_else(Search::nothing)?;
        let tuned = Tuned {
            changes: trial.changes(&before.calibration, &after.calibration),
            before: before.figures,
            after: after.figures,
            figures: before.compared(&after),
        };
        let page = match &self.report {
            Some(_) => report(model, (&moves, &presses), &tuned, [&before, &after]),
            None => String::new(),
        };
        Ok(Found {
            calibration: after.calibration,
            tuned,
            page,
        })
    }
}

/// The report: moves and presses with both calibrations, the initial one first.
fn report(
    model: &Model,
    (moves, presses): (&[Move], &[Press]),
    tuned: &Tuned,
    judged: [&Judged; 2],
) -> String {
    let progress = Progress::start("driving the moves with both calibrations");
    let moved = judged.map(|judged| closed_loop::run(model, &judged.calibration, moves));
    let pressed = judged.map(|judged| run_presses(model, &judged.calibration, presses));
    let page = tuning_page::page(&tuning_page::Shown {
        model,
        changes: &tuned.changes,
        figures: &tuned.figures,
        moves: both::<LoopRun>(&moved),
        presses: both::<PressRun>(&pressed),
    });
    drop(progress);
    page
}

/// Both, if both are there.
fn both<T>(pair: &[Option<T>; 2]) -> Option<[&T; 2]> {
    let [before, after] = pair;
    Some([before.as_ref()?, after.as_ref()?])
}

/// The search starts with the hysteresis of a real valve, which can cost more than the initial calibration.
fn worse(args: &Args, tuned: &Tuned) -> Error {
    Error::Failed(format!(
        "the best calibration found is worse than the initial one (cost {:.3} after {:.3}; a search of moves keeps the \
         hysteresis of a real valve, and one of the field is judged on other soils): {} is not written; try more --trials, \
         keep the initial one, or write it with --force",
        tuned.after.cost,
        tuned.before.cost,
        args.out.display()
    ))
}
