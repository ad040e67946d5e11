//! `hitch loop`: runs the firmware's controller in closed loop with the plant.

use std::path::PathBuf;

use hitch_closed_loop::driven::MachineError;
use hitch_controller_host::calibration_file;
use hitch_plant::Model;
use hitch_quantities::ValidCalibration;
use schemars::JsonSchema;
use serde::Serialize;

use crate::commands::loop_scenario::{self, LoopScenario};
use hitch_output::JsonArg;
use hitch_output::error::Error;
use hitch_output::progress::Progress;
use hitch_output::targets::Outputs;
use hitch_results::arguments::number::{LOADS_KG, OIL_C, number};
use hitch_results::closed_loop::ScenarioFigure;
use hitch_results::closed_loop::show::{presses_text, text};
use hitch_results::closed_loop::show_variants;
use hitch_results::closed_loop::variant::{self, BASE, Variant};
use hitch_results::closed_loop::{
    LoopRun, MoveResult, OIL_TEMPERATURE_C, PressResult, PressRun, PressSummary, Summary, presses,
    run_presses, run_quick_lift,
};
use hitch_results::field_loop::scenario::{self, FieldScenario};
use hitch_results::report::{field_page, loop_page, variants_page};
use hitch_results::{closed_loop, field_loop};

/// Arguments of `hitch loop`.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Example: hitch loop --model explained.toml --calibration calibration.toml --report loop.html\n\
    Variants side by side: hitch loop --scenario quick --variant soft:position.approach_gain=30 \
    --variant slow:position.creep_speed=2 --report variants.html\n\n\
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
    /// Drive the same scenario with this variant of the calibration too, and show all side by side; may be given up to
    /// five times, as in soft:position.approach_gain=30,position.creep_speed=3
    #[arg(long = "variant", value_name = "NAME:GROUP.KEY=VALUE,...")]
    variants: Vec<Variant>,
    /// Moves to drive
    #[arg(long, value_enum, default_value_t)]
    scenario: LoopScenario,
    /// Only this load at the hitch, kg
    #[arg(long, value_name = "KG", allow_negative_numbers = true, value_parser = number(LOADS_KG), conflicts_with = "loads")]
    load: Option<f64>,
    /// Loads at the hitch, kg; without this option, 3, 9 and 15 % of what the model can lift
    #[arg(long, value_name = "KG,KG", value_delimiter = ',', value_parser = number(LOADS_KG))]
    loads: Option<Vec<f64>>,
    /// Oil temperatures, C; without this option, those of the scenario: 40, or 10, 40 and 70
    #[arg(long, value_name = "C,C", value_delimiter = ',', allow_negative_numbers = true, value_parser = number(OIL_C))]
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
    #[serde(flatten)]
    figures: Figures<'a>,
    /// The same scenario with the variants of the calibration, in their order; absent without variants.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    variants: Vec<DrivenVariant<'a>>,
}

/// Figures of a calibration in a scenario.
#[derive(Debug, Default, Serialize, JsonSchema)]
struct Figures<'a> {
    /// Figures of each move, in the order of the scenario.
    moves: &'a [MoveResult],
    /// Figures of all moves; absent for rate control.
    #[serde(skip_serializing_if = "Option::is_none")]
    summary: Option<Summary>,
    /// Figures of each press of the button; absent for scenarios of moves.
    #[serde(skip_serializing_if = "Option::is_none")]
    presses: Option<&'a [PressResult]>,
    /// Figures of all presses; absent for scenarios of moves.
    #[serde(skip_serializing_if = "Option::is_none")]
    press_summary: Option<PressSummary>,
    /// Figures of a function in the field; absent for other scenarios.
    #[serde(skip_serializing_if = "Option::is_none")]
    field: Option<&'a [ScenarioFigure]>,
}

impl<'a> Figures<'a> {
    fn of_moves(run: &'a LoopRun) -> Self {
        Self {
            moves: &run.results,
            summary: Some(run.summary),
            ..Self::default()
        }
    }

    fn of_presses(run: &'a PressRun) -> Self {
        Self {
            presses: Some(&run.results),
            press_summary: Some(run.summary),
            ..Self::default()
        }
    }
}

/// A variant of the calibration with its figures, as for the calibration without it.
#[derive(Debug, Serialize, JsonSchema)]
struct DrivenVariant<'a> {
    /// Its name.
    name: &'a str,
    /// Its settings, as `group.key=value`.
    settings: &'a [String],
    #[serde(flatten)]
    figures: Figures<'a>,
}

/// Runs the command.
///
/// # Errors
/// If the model or the calibration is invalid, a result cannot be written, or a move never arrives.
pub fn run(args: &Args) -> Result<(), Error> {
    let inputs = read_files(&args.model, args.calibration.as_ref());
    let outputs = Outputs::check([args.report.as_deref(), args.json.target()], &inputs)?;
    variant::check(&args.variants).map_err(|what| Error::Usage(format!("--variant: {what}")))?;
    let model = hitch_model_file::named(&args.model)?;
    let base = changed(&calibration(args.calibration.as_ref())?, &args.set)?;
    let job = Job {
        args,
        outputs: &outputs,
        calibrations: calibrations(&base, &args.variants)?,
        model: &model,
        loads_kg: args.load.map(|load| vec![load]).or(args.loads.clone()),
    };
    match args.scenario {
        LoopScenario::Rate => job.run_rate(),
        LoopScenario::Field(scenario) => job.run_field(scenario),
        _ => job.run_moves(),
    }
}

/// The calibration and its variants.
fn calibrations(
    base: &ValidCalibration,
    variants: &[Variant],
) -> Result<Vec<ValidCalibration>, Error> {
    let mut all = vec![base.clone()];
    for variant in variants {
        let varied = calibration_file::with_settings(base, &variant.settings)
            .map_err(|what| Error::Usage(format!("--variant {}: {what}", variant.name)))?;
        all.push(varied);
    }
    Ok(all)
}

/// A scenario, and what it is driven with.
struct Job<'a> {
    args: &'a Args,
    outputs: &'a Outputs<'a>,
    model: &'a Model,
    /// The calibration, and its variants.
    calibrations: Vec<ValidCalibration>,
    loads_kg: Option<Vec<f64>>,
}

impl Job<'_> {
    /// Drives moves.
    fn run_moves(&self) -> Result<(), Error> {
        let progress = Progress::start("driving the moves");
        let runs: Vec<LoopRun> = self
            .calibrations
            .iter()
            .filter_map(|calibration| self.drive(calibration))
            .collect();
        drop(progress);
        let named = self.named(&runs);
        let Some((base, varied)) = runs.split_first() else {
            return Err(Error::Usage("the scenario has no moves".to_owned()));
        };
        hitch_output::write_if(self.args.report.as_ref(), || match varied {
            [] => self.page(base),
            _ => variants_page::of_moves(&self.setup(), &named),
        })?;
        let document = self.document(base, varied, Figures::of_moves);
        self.outputs.tell(&self.args.json, &document, || {
            if document.variants.is_empty() {
                text(&base.results, &base.summary)
            } else {
                show_variants::moves_text(&named)
            }
        })?;
        // The results are complete, but they do not have what was asked for.
        let mut missed = named.iter().filter_map(|(name, run)| {
            let what = closed_loop::first_missed(run)?;
            Some(self.of_variant(name, what))
        });
        missed.next().map_or(Ok(()), |what| Err(Error::Usage(what)))
    }

    /// Drives the presses of the button.
    fn run_rate(&self) -> Result<(), Error> {
        let oil_c = self.args.oil_temperatures.as_deref();
        let oil_c = oil_c.unwrap_or(&[OIL_TEMPERATURE_C]);
        let base = self.calibrations.first();
        let presses = base.map_or_else(Vec::new, |base| {
            presses(self.model, base, self.loads_kg.as_deref(), oil_c)
        });
        let progress = Progress::start(format!("driving {} presses", presses.len()));
        let runs: Vec<PressRun> = self
            .calibrations
            .iter()
            .filter_map(|calibration| run_presses(self.model, calibration, &presses))
            .collect();
        drop(progress);
        let named = self.named(&runs);
        let Some((base, varied)) = runs.split_first() else {
            return Err(Error::Usage("the scenario has no presses".to_owned()));
        };
        hitch_output::write_if(self.args.report.as_ref(), || {
            variants_page::of_presses(&self.setup(), &named)
        })?;
        let document = self.document(base, varied, Figures::of_presses);
        self.outputs.tell(&self.args.json, &document, || {
            if document.variants.is_empty() {
                presses_text(&base.results, &base.summary)
            } else {
                show_variants::presses_text(&named)
            }
        })?;
        let mut stuck = named.iter().filter_map(|(name, run)| {
            let mut presses = run.results.iter();
            let index = presses.position(|press| press.start_delay_s.is_nan())?;
            Some(self.of_variant(name, format!(
                "press {} never reaches half of its speed: the load is too heavy, or the valve map does not fit the \
                 plant; build it with `hitch calibrate`",
                index + 1
            )))
        });
        stuck.next().map_or(Ok(()), |what| Err(Error::Usage(what)))
    }

    /// Drives a function in the field.
    fn run_field(&self, scenario: FieldScenario) -> Result<(), Error> {
        let has_others = !self.args.variants.is_empty()
            || self.loads_kg.is_some()
            || self.args.oil_temperatures.is_some();
        if has_others {
            return Err(Error::Usage(
                "scenarios of the field have their own loads and oil temperature, and no variants: leave --load, \
                 --loads, --oil-temperatures and --variant out, and change the calibration by --set"
                    .to_owned(),
            ));
        }
        let model = hitch_closed_loop::with_dynamics(self.model).map_err(MachineError::from)?;
        let Some(base) = self.calibrations.first() else {
            return Ok(());
        };
        let progress = Progress::start("driving in the field");
        let run = scenario::drive(scenario, &model, base, 1).map_err(Error::Usage)?;
        drop(progress);
        hitch_output::write_if(self.args.report.as_ref(), || {
            let name = loop_scenario::typed(&scenario);
            field_page::page(&name, &model, &self.source(), &run)
        })?;
        let document = Driven {
            figures: Figures {
                field: Some(&run.figures),
                ..Figures::default()
            },
            variants: Vec::new(),
        };
        self.outputs.tell(&self.args.json, &document, || {
            field_loop::show::text(&run.figures)
        })
    }

    /// The document of a run, and of those of the variants.
    fn document<'r, Run>(
        &'r self,
        base: &'r Run,
        varied: &'r [Run],
        figures: fn(&'r Run) -> Figures<'r>,
    ) -> Driven<'r> {
        let variants = self.args.variants.iter().zip(varied);
        let variants = variants.map(|(variant, run)| DrivenVariant {
            name: &variant.name,
            settings: &variant.settings,
            figures: figures(run),
        });
        Driven {
            figures: figures(base),
            variants: variants.collect(),
        }
    }

    /// A fault of a run; with variants, after the name of its calibration.
    fn of_variant(&self, name: &str, what: String) -> String {
        if self.args.variants.is_empty() {
            what
        } else {
            format!("{name}: {what}")
        }
    }

    /// The runs with the names of their calibrations.
    fn named<'r, Run>(&'r self, runs: &'r [Run]) -> Vec<(&'r str, &'r Run)> {
        let variants = self
            .args
            .variants
            .iter()
            .map(|variant| variant.name.as_str());
        let base = if self.args.variants.is_empty() {
            "hitch"
        } else {
            BASE
        };
        [base].into_iter().chain(variants).zip(runs).collect()
    }

    /// Drives a scenario of moves.
    fn drive(&self, calibration: &ValidCalibration) -> Option<LoopRun> {
        let (loads_kg, oil_c) = (
            self.loads_kg.as_deref(),
            self.args.oil_temperatures.as_deref(),
        );
        drive(self.args.scenario, self.model, calibration, loads_kg, oil_c)
    }

    /// Source of the calibration.
    fn source(&self) -> String {
        let path = self.args.calibration.as_ref();
        path.map_or_else(|| "nominal".to_owned(), |path| path.display().to_string())
    }

    /// The report of a single calibration.
    fn page(&self, run: &LoopRun) -> String {
        loop_page::page(&loop_page::Shown {
            model: self.model,
            calibration: &self.source(),
            settings: &self.args.set,
            run,
        })
    }

    /// The head of a report of several calibrations.
    fn setup(&self) -> variants_page::Setup<'_> {
        variants_page::Setup {
            model: self.model,
            calibration: self.args.calibration.as_deref(),
            settings: &self.args.set,
            variants: &self.args.variants,
        }
    }
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
        LoopScenario::QuickLift | LoopScenario::Rate | LoopScenario::Field(_) => run_quick_lift(
            model,
            calibration,
            loads_kg.unwrap_or(&model.usual_loads_kg()),
            oil_c.unwrap_or(&[OIL_TEMPERATURE_C]),
        ),
    }
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
