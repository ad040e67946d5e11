//! `hitch export-fmu`: plant or controller as a unit for co-simulation.

use std::path::{Path, PathBuf};
use std::{env, fs};

use hitch_controller_host::calibration_file;
use hitch_fmu::kind::Kind;
use hitch_input::input_error::InputError;
use hitch_input::source_file::SourceFile;

use super::loop_::{calibration, read_files};
use hitch_output::error::Error;
use hitch_output::progress::Progress;
use hitch_output::targets::Outputs;
use hitch_results::fmu_export;

/// Arguments of `hitch export-fmu`.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Examples:\n  hitch export-fmu explained.toml --out plant.fmu\n  \
    hitch export-fmu --controller --calibration calibration.toml --out controller.fmu\n\n\
    The unit follows FMI 2.0 for co-simulation and runs on machines like this one. It holds the shared library, the \
    model or the calibration, and modelDescription.xml, which lists the variables with their units."
)]
pub struct Args {
    /// The plant: nominal, dynamic, or the name of a model file
    #[arg(value_name = "MODEL", default_value = "dynamic")]
    model: String,
    /// Export the firmware's controller instead of the plant
    #[arg(long)]
    controller: bool,
    /// The controller's calibration; without it, the nominal one
    #[arg(long, value_name = "C.toml", requires = "controller")]
    calibration: Option<PathBuf>,
    /// Where the unit goes
    #[arg(long, value_name = "F.fmu")]
    out: PathBuf,
}

/// Runs the command.
///
/// # Errors
/// If the model or the calibration is wrong, the shared library is missing, or the unit cannot be written.
pub fn run(args: &Args) -> Result<(), Error> {
    hitch_output::no_stdout("--out", Some(&args.out), "a unit is no text")?;
    let inputs = read_files(&args.model, args.calibration.as_ref());
    Outputs::check([Some(args.out.as_path())], &inputs)?;
    let (kind, file) = args.content()?;
    let library = library()?;
    let progress = Progress::start(format!("writing {}", args.out.display()));
    let unit = fmu_export::archive(kind, &file, &library)?;
    drop(progress);
    hitch_output::write_file(&args.out, &unit)
}

impl Args {
    /// What the unit holds. The model and the calibration are written anew, complete.
    fn content(&self) -> Result<(Kind, SourceFile), Error> {
        let model = hitch_model_file::named(&self.model)?;
        let (kind, text) = if !self.controller {
            (Kind::Plant, hitch_model_file::to_toml(&model))
        } else {
            let calibration = calibration(self.calibration.as_ref())?;
            (Kind::Controller, calibration_file::write(&calibration))
        };
        let path = Path::new(kind.file()).to_path_buf();
        Ok((kind, SourceFile { path, text }))
    }
}

/// The bytes of the shared library.
fn library() -> Result<Vec<u8>, Error> {
    let program = env::current_exe()
        .and_then(fs::canonicalize)
        .map_err(|error| {
            Error::Failed(format!("the folder of the program is not known: {error}"))
        })?;
    let file = fmu_export::find(&program)?;
    fs::read(&file).map_err(|error| {
        let what = format!("cannot be read: {error}");
        InputError::of_file(&file, what, "build it again with `cargo build --release`").into()
    })
}
