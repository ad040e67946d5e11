//! `hitch loop`: runs the firmware's controller in closed loop with the plant.

use std::path::PathBuf;

use hitch_controller_host::calibration_file;
use hitch_plant::Model;
use hitch_quantities::ValidCalibration;
use schemars::JsonSchema;
use serde::Serialize;

use crate::closed_loop::show::{presses_text, text};
use crate::closed_loop::{
    LoopRun, MoveResult, OIL_TEMPERATURE_C, PressResult, Summary, drive_presses, presses,
    run_quick_lift,
};
use crate::commands::loop_scenario::LoopScenario;
use crate::error::Error;
use crate::output::JsonArg;
use crate::outputs::Outputs;
use crate::progress::Progress;
use crate::report::loop_page;
use crate::{closed_loop, output};

/// Arguments of `hitch loop`.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Example: hitch loop --model explained.toml --calibration calibration.toml --report loop.html\n\n\
    The shortest time is that of an ideal manoeuvre: the valve opens fully in an edge of 100 ms, stays open, and \
    closes with the same edge, so that the hitch comes to rest at the set point. Times end within half a degree of it. \
    A controller with steeper edges can be faster, at the cost of a larger pressure swing; its time ratio is below 1. \
    A move that does not stay within half a degree has not arrived: it has neither time nor ratio (JSON: arrived \
    false, null), and the summary excludes it; the command then ends with the likely cause and exit code 2. A move that the relief valve prevents has no shortest time."
)]
pub struct Args {
    /// The plant: nominal, dynamic, or the name of a model file
    #[arg(long, value_name = "MODEL", default_value = "dynamic")]
    model: String,
    /// Calibration of the controller; without this option, the nominal one
    #[arg(long, value_name = "C.toml")]
    calibration: Option<PathBuf>,
    /// Change a value of the calibration, as in position.approach_gain=30; may be given several times
    #[arg(long, value_name = "GROUP.KEY=VALUE")]
    set: Vec<String>,
    /// Moves to drive
    #[arg(long, value_enum, default_value_t)]
    scenario: LoopScenario,
    /// Only this load at the hitch, kg
    #[arg(long, value_name = "KG", allow_negative_numbers = true, value_parser = load_kg, conflicts_with = "loads")]
    load: Option<f64>,
    /// Loads at the hitch, kg; without this option, 3, 9 and 15 % of what the model can lift
    #[arg(long, value_name = "KG,KG", value_delimiter = ',', value_parser = load_kg)]
    loads: Option<Vec<f64>>,
    /// Oil temperatures, C; without this option, those of the scenario: 40, or 10, 40 and 70
    #[arg(long, value_name = "C,C", value_delimiter = ',', allow_negative_numbers = true, value_parser = temperature_c)]
    oil_temperatures: Option<Vec<f64>>,
    #[command(flatten)]
    json: JsonArg,
    /// Write a report to this file: worst cases, step responses over load and oil temperature, traces of moves
    #[arg(long, value_name = "FILE.html")]
    report: Option<PathBuf>,
}

/// Result of `hitch loop`.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Driven<'a> {
    /// Figures of each move, in the order of the scenario.
    moves: &'a [MoveResult],
    /// Figures of all moves; absent for rate control.
    #[serde(skip_serializing_if = "Option::is_none")]
    summary: Option<Summary>,
    /// Figures of each press of the button; absent for scenarios of moves.
    #[serde(skip_serializing_if = "Option::is_none")]
    presses: Option<&'a [PressResult]>,
}

/// Runs the command.
///
/// # Errors
/// If the model or the calibration is invalid, a result cannot be written, or a move never arrives.
pub fn run(args: &Args) -> Result<(), Error> {
    let inputs = read_files(&args.model, args.calibration.as_ref());
    let outputs = Outputs::check([args.report.as_deref(), args.json.target()], &inputs)?;
    let model = hitch_model_file::named(&args.model)?;
    let calibration = changed(&calibration(args.calibration.as_ref())?, &args.set)?;
    let only = args.load.map(|load| vec![load]);
    let loads = only.or_else(|| args.loads.clone());
    let oil_c = args.oil_temperatures.as_deref();
    if args.scenario == LoopScenario::Rate {
        return run_rate(args, &outputs, &model, &calibration, loads.as_deref());
    }
    let progress = Progress::start("driving the moves");
    let driven = drive(args.scenario, &model, &calibration, loads.as_deref(), oil_c)
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
    let document = Driven {
        moves: &driven.results,
        summary: Some(driven.summary),
        presses: None,
    };
    outputs.tell(&args.json, &document, || {
        text(&driven.results, &driven.summary)
    })?;
    // The results are complete, but they do not have what was asked for.
    closed_loop::first_missed(&driven).map_or(Ok(()), |what| Err(Error::Usage(what)))
}

/// Drives a scenario of moves.
fn drive(
    scenario: LoopScenario,
    model: &Model,
    calibration: &ValidCalibration,
    loads_kg: Option<&[f64]>,
    oil_c: Option<&[f64]>,
) -> Option<LoopRun> {
    match scenario {
        LoopScenario::Moves(scenario) => {
            let moves = scenario.moves_with_oil(model, loads_kg, oil_c);
            closed_loop::run(model, calibration, &moves)
        }
        LoopScenario::QuickLift | LoopScenario::Rate => run_quick_lift(
            model,
            calibration,
            loads_kg.unwrap_or(&model.usual_loads_kg()),
            oil_c.unwrap_or(&[OIL_TEMPERATURE_C]),
        ),
    }
}

/// Drives the presses of the button.
fn run_rate(
    args: &Args,
    outputs: &Outputs,
    model: &Model,
    calibration: &ValidCalibration,
    loads_kg: Option<&[f64]>,
) -> Result<(), Error> {
    if args.report.is_some() {
        return Err(Error::Usage(
            "--report: has no page for rate control; take --json, or another --scenario".to_owned(),
        ));
    }
    let oil_c = args.oil_temperatures.as_deref();
    let presses = presses(
        model,
        calibration,
        loads_kg,
        oil_c.unwrap_or(&[OIL_TEMPERATURE_C]),
    );
    let progress = Progress::start(format!("driving {} presses", presses.len()));
    let results = drive_presses(model, calibration, &presses);
    drop(progress);
    let document = Driven {
        moves: &[],
        summary: None,
        presses: Some(&results),
    };
    outputs.tell(&args.json, &document, || presses_text(&results))?;
    let stuck = results
        .iter()
        .position(|press| press.start_delay_s.is_nan());
    stuck.map_or(Ok(()), |index| {
        Err(Error::Usage(format!(
            "press {} never reaches half of its speed: the load is too heavy, or the valve map does not fit the plant; \
             build it with `hitch calibrate`",
            index + 1
        )))
    })
}

/// Names of the model and calibration files, as given on the command line.
#[must_use]
pub fn read_files(model: &str, calibration: Option<&PathBuf>) -> Vec<PathBuf> {
    let model = PathBuf::from(model);
    calibration.cloned().into_iter().chain([model]).collect()
}

/// The calibration with settings from the command line.
///
/// # Errors
/// If a setting is invalid.
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
/// If the file is invalid.
pub fn calibration(path: Option<&PathBuf>) -> Result<ValidCalibration, Error> {
    match path {
        Some(path) => Ok(calibration_file::read(path)?),
        None => hitch_quantities::Calibration::nominal()
            .validate()
            .map_err(|error| {
                Error::Failed(format!("the nominal calibration is invalid: {error:?}"))
            }),
    }
}

/// Largest load of a hitch, kg: category 4 lifts 13 t.
const MOST_KG: f64 = 20_000.0;

/// Parses an oil temperature from the command line.
///
/// # Errors
/// If it is not one of hydraulic oil.
pub fn temperature_c(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(temperature_c) if (-40.0..=120.0).contains(&temperature_c) => Ok(temperature_c),
        _ => Err("it has to be a number from -40 to 120".to_owned()),
    }
}

/// Parses a load from the command line.
///
/// # Errors
/// If it is not a valid load.
pub fn load_kg(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(load_kg) if (0.0..=MOST_KG).contains(&load_kg) => Ok(load_kg),
        _ => Err(format!("it has to be a number from 0 to {MOST_KG}")),
    }
}
