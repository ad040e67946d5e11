//! `hitch loop`: the firmware's controller in closed loop with the plant.

use std::path::PathBuf;

use hitch_quantities::ValidCalibration;
use serde::Serialize;

use crate::closed_loop::show::text;
use crate::closed_loop::{MoveResult, Scenario, Summary};
use crate::error::Error;
use crate::output::JsonArg;
use crate::outputs::Outputs;
use crate::progress::Progress;
use crate::report::loop_page;
use crate::{calibration_file, closed_loop, output};

/// Arguments of `hitch loop`.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Example: hitch loop --model explained.toml --calibration calibration.toml --report loop.html\n\n\
    The shortest time is that of an ideal manoeuvre: the valve opens fully in an edge of 100 ms, stays open, and \
    closes in such an edge, so that the hitch comes to rest on the set point; until it is within half a degree. A \
    controller that opens or closes its valve more steeply takes less, for a larger pressure swing: a ratio below 1. A \
    move that never stays within half a degree has not arrived: it has no time and no ratio (JSON: arrived false, \
    null), and the summary is of the others. What the relief valve forbids has no shortest time either."
)]
pub struct Args {
    /// The plant: nominal, dynamic, or the name of a model file
    #[arg(long, value_name = "MODEL", default_value = "dynamic")]
    model: String,
    /// The controller's calibration; without it, the nominal one
    #[arg(long, value_name = "C.toml")]
    calibration: Option<PathBuf>,
    /// Changes a value of the calibration, as in position.approach_gain=30; may be given several times
    #[arg(long, value_name = "GROUP.KEY=VALUE")]
    set: Vec<String>,
    /// Which moves are driven
    #[arg(long, value_enum, default_value_t = Scenario::Moves)]
    scenario: Scenario,
    /// Only this load at the hitch, kg
    #[arg(long, value_name = "KG", allow_negative_numbers = true, value_parser = load_kg)]
    load: Option<f64>,
    #[command(flatten)]
    json: JsonArg,
    /// Write a report to this file: worst cases, step responses over load and oil temperature, courses of moves
    #[arg(long, value_name = "FILE.html")]
    report: Option<PathBuf>,
}

/// The result as a JSON document.
#[derive(Debug, Serialize)]
struct Document<'a> {
    moves: &'a [MoveResult],
    summary: Summary,
}

/// Runs the command.
///
/// # Errors
/// If the model or the calibration is wrong, or a result cannot be written.
pub fn run(args: &Args) -> Result<(), Error> {
    let inputs = read_files(&args.model, args.calibration.as_ref());
    let outputs = Outputs::check([args.report.as_deref(), args.json.target()], &inputs)?;
    let model = hitch_model_file::named(&args.model)?;
    let calibration = changed(&calibration(args.calibration.as_ref())?, &args.set)?;
    let moves = args.scenario.moves(args.load);
    let progress = Progress::start(format!("driving {} moves", moves.len()));
    let driven = closed_loop::run(&model, &calibration, &moves)
        .ok_or_else(|| Error::Usage("the scenario has no moves".to_owned()))?;
    drop(progress);
    if let Some(path) = &args.report {
        let source = args
            .calibration
            .as_ref()
            .map(|path| path.display().to_string());
        let page = loop_page::page(&loop_page::Shown {
            model: &model,
            calibration: source.as_deref().unwrap_or("nominal"),
            settings: &args.set,
            run: &driven,
        });
        output::write_file(path, page.as_bytes())?;
    }
    let document = Document {
        moves: &driven.results,
        summary: driven.summary,
    };
    outputs.tell(&args.json, &document, || {
        text(&driven.results, &driven.summary)
    })
}

/// The files of a model and a calibration, as the command line names them.
#[must_use]
pub fn read_files(model: &str, calibration: Option<&PathBuf>) -> Vec<PathBuf> {
    let model = PathBuf::from(model);
    calibration.cloned().into_iter().chain([model]).collect()
}

/// The calibration with settings from the command line.
///
/// # Errors
/// If a setting is wrong.
pub fn changed(
    calibration: &ValidCalibration,
    settings: &[String],
) -> Result<ValidCalibration, Error> {
    calibration_file::with_settings(calibration, settings)
        .map_err(|what| Error::Usage(format!("--set: {what}")))
}

/// The calibration of a file, or the nominal one.
///
/// # Errors
/// If the file is wrong.
pub fn calibration(path: Option<&PathBuf>) -> Result<ValidCalibration, Error> {
    match path {
        Some(path) => Ok(calibration_file::read(path)?),
        None => hitch_quantities::Calibration::nominal()
            .validate()
            .map_err(|error| {
                Error::Failed(format!("the nominal calibration is refused: {error:?}"))
            }),
    }
}

/// A load from the command line.
///
/// # Errors
/// If it is none.
pub fn load_kg(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(load_kg) if (0.0..=2000.0).contains(&load_kg) => Ok(load_kg),
        _ => Err("it has to be a number from 0 to 2000".to_owned()),
    }
}
