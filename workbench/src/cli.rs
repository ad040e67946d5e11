//! The command line.
use clap::{CommandFactory, Parser, Subcommand};

#[cfg(feature = "fmu")]
use crate::commands::export_fmu;
#[cfg(feature = "page")]
use crate::commands::serve;
use crate::commands::{
    add, adopt, calibrate, changes, compare, completions, controller, diagnose, draft, effects,
    explain, import, loop_, main_job, man, model, schema, simulate, summary, tune,
};
#[cfg(feature = "ecu")]
use crate::commands::{ecu, flash_calibration, record};
use hitch_output::error::Error;

/// The electro-hydraulic hitch: measurement -> physics -> firmware -> motion.
#[derive(Debug, Parser)]
#[command(name = "hitch", version, about, args_conflicts_with_subcommands = true)]
#[command(after_help = "Examples:\n  hitch\n  hitch explain lab-a --report lab-a.html")]
pub struct Cli {
    /// Command; without one, the demonstration campaign is processed from measurement to motion
    #[command(subcommand)]
    pub command: Option<Command>,
    /// Options without a command.
    #[command(flatten)]
    pub main_job: main_job::Args,
}

/// All commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Compare a model with measurements: error by condition, time and channel
    Compare(compare::Args),
    /// Rank missing physical effects, and list those that are indistinguishable on these data
    Diagnose(diagnose::Args),
    /// Add effects to a model and estimate their parameters
    Add(add::Args),
    /// Find and add missing effects until no further one is significant
    Explain(explain::Args),
    /// Adopt a machine: fit constants and effects of a data sheet's model to a campaign of it
    Adopt(adopt::Args),
    /// Compare two campaigns of a machine, or of two machines of a series
    Changes(changes::Args),
    /// Fit an implement and its soil to a draft campaign, and find hidden effects: sensor zeros, blunt shares, wheel tracks
    Draft(draft::Args),
    /// Summarise the lines of many campaigns: machine by effect, and which machines differ
    Summary(summary::Args),
    #[cfg(feature = "page")]
    /// Show campaign and model in the browser (local only): compare, rank and add effects
    Serve(serve::Args),
    /// List the catalogue of physical effects: equation, parameters, units, source, visibility
    Effects(effects::Args),
    /// Create a model file from data sheets, or fit its constants to a campaign
    Model(model::Args),
    /// Simulate the plant with the currents of a log
    Simulate(simulate::Args),
    /// Run the firmware's controller in closed loop with the plant
    Loop(loop_::Args),
    /// Run the firmware's controller on stdin/stdout, for an external plant
    Controller(controller::Args),
    #[cfg(feature = "fmu")]
    /// Export the plant or the controller as an FMI 2.0 co-simulation unit (FMU)
    ExportFmu(export_fmu::Args),
    #[cfg(feature = "ecu")]
    /// Run the firmware image on an emulated Cortex-M4 with plant, and CAN on a TCP port
    Ecu(ecu::Args),
    #[cfg(feature = "ecu")]
    /// Write a calibration to a running ECU, with verification
    FlashCalibration(flash_calibration::Args),
    #[cfg(feature = "ecu")]
    /// Record a campaign from a running ECU
    Record(record::Args),
    /// Import a campaign from existing logs (tables, MDF, CAN), which are read in place
    Import(import::Args),
    /// Tune position and rate control against the plant, over loads and valve spread
    Tune(tune::Args),
    /// Print the JSON Schema of the document that a command writes with --json
    Schema(schema::Args),
    /// Print the completions of a shell for commands and options
    Completions(completions::Args),
    /// Print the manual page of the program or of a command
    Man(man::Args),
    /// Convert an identified model into the firmware's calibration: valve map, thresholds, limits
    Calibrate(calibrate::Args),
}

impl Command {
    /// Runs the command.
    ///
    /// # Errors
    /// The error of the command.
    pub fn run(&self) -> Result<(), Error> {
        match self {
            Self::Compare(args) => compare::run(args),
            Self::Diagnose(args) => diagnose::run(args),
            Self::Add(args) => add::run(args),
            Self::Explain(args) => explain::run(args),
            Self::Adopt(args) => adopt::run(args),
            Self::Changes(args) => changes::run(args),
            Self::Summary(args) => summary::run(args),
            #[cfg(feature = "page")]
            Self::Serve(args) => serve::run(args),
            Self::Effects(args) => effects::run(args),
            Self::Model(args) => model::run(args),
            Self::Simulate(args) => simulate::run(args),
            Self::Loop(args) => loop_::run(args),
            Self::Controller(args) => controller::run(args),
            #[cfg(feature = "fmu")]
            Self::ExportFmu(args) => export_fmu::run(args),
            Self::Draft(args) => draft::run(args),
            #[cfg(feature = "ecu")]
            Self::Ecu(args) => ecu::run(args),
            #[cfg(feature = "ecu")]
            Self::FlashCalibration(args) => flash_calibration::run(args),
            #[cfg(feature = "ecu")]
            Self::Record(args) => record::run(args),
            Self::Import(args) => import::run(args),
            Self::Schema(args) => schema::run(args),
            Self::Completions(args) => completions::run(args, Cli::command()),
            Self::Man(args) => man::run(args, Cli::command()),
            Self::Tune(args) => tune::run(args),
            Self::Calibrate(args) => calibrate::run(args),
        }
    }
}

/// Parses the program's arguments and runs the command.
///
/// # Errors
/// If the arguments are invalid, or the command fails.
pub fn run<I: IntoIterator<Item = std::ffi::OsString>>(arguments: I) -> Result<(), Error> {
    match Cli::try_parse_from(arguments) {
        Ok(Cli {
            command: Some(command),
            ..
        }) => command.run(),
        Ok(Cli { main_job, .. }) => main_job::run(&main_job),
        Err(error) if !error.use_stderr() => hitch_output::print(&error.render().to_string()),
        Err(error) => Err(Error::Usage(one_line(&error.render().to_string()))),
    }
}

/// Joins clap's message into one line: the fault and its tips, without the usage.
fn one_line(message: &str) -> String {
    let is_told =
        |line: &&str| !line.starts_with("Usage:") && !line.starts_with("For more information");
    let told = message.lines().map(str::trim).take_while(is_told);
    let lines: Vec<&str> = told.filter(|line| !line.is_empty()).collect();
    let line = lines.join(" ").replace(" tip:", ";").replace("  ", " ");
    format!("{}; see --help", line.trim_start_matches("error: "))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fault(arguments: &[&str]) -> String {
        let arguments = ["hitch"]
            .iter()
            .chain(arguments)
            .map(std::ffi::OsString::from);
        run(arguments).unwrap_err().to_string()
    }

    #[test]
    fn definition_is_sound() {
        Cli::command().debug_assert();
    }

    #[test]
    fn wrong_usage_is_one_line() {
        let option = fault(&["effects", "--jsn", "-"]);
        assert_eq!(
            option,
            "unexpected argument '--jsn' found; a similar argument exists: '--json'; see --help"
        );
        let value = fault(&[
            "simulate", "--load", "-5", "--inputs", "i.csv", "--out", "o.csv",
        ]);
        assert_eq!(
            value,
            "invalid value '-5' for '--load <KG>': the range is 0 to 20000; see --help"
        );
        assert!(fault(&["papr"]).starts_with("unrecognized subcommand 'papr'; "));
    }

    #[test]
    fn help_lists_everything_that_is_tuned() {
        let command = Cli::command();
        let tune = command.find_subcommand("tune").unwrap();
        let help = tune.get_after_help().unwrap().to_string();
        for knob in hitch_results::tuning::KNOBS {
            let (_, name) = knob.split_once('.').unwrap();
            assert!(help.contains(name), "{knob}: {help}");
        }
    }

    #[test]
    fn every_command_has_an_example() {
        for command in Cli::command().get_subcommands() {
            let help = command
                .get_after_help()
                .map(ToString::to_string)
                .unwrap_or_default();
            assert!(
                help.starts_with("Example"),
                "{} has no example",
                command.get_name()
            );
        }
    }
}
