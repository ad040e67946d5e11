//! `hitch calibrate`: converts an identified model into the firmware's calibration.

use std::path::PathBuf;

use hitch_controller_host::calibration_file;
use hitch_quantities::calibration::valve_table::ValveTable;

use super::loop_::{calibration, read_files};
use hitch_closed_loop::calibrate::working::with_draft;
use hitch_closed_loop::calibrate::{calibrate, carried};
use hitch_output::error::Error;
use hitch_output::targets::Outputs;
use hitch_output::text::indented;
use hitch_results::draft::read_working;

/// Arguments of `hitch calibrate`.
#[derive(Debug, clap::Args)]
#[command(after_help = "Example: hitch calibrate explained.toml --out calibration.toml")]
pub struct Args {
    /// The identified model: a model file, nominal or dynamic
    #[arg(value_name = "MODEL")]
    model: String,
    /// Write the calibration to this file
    #[arg(long, value_name = "C.toml")]
    out: PathBuf,
    /// Calibration with the remaining values (gains, ramps, limits); without this option, the nominal one
    #[arg(long, value_name = "C.toml")]
    calibration: Option<PathBuf>,
    /// Document that `hitch draft --json` wrote: the implement's draft sets values of draft and depth control
    #[arg(long, value_name = "DRAFT.json")]
    draft: Option<PathBuf>,
}

/// What of draft and depth control does not follow from an implement.
const NOT_FROM_A_DRAFT: &str = "zeros and spans of pins and depth sensor are taught; draft.length is the implement's own; filters, dead bands \
     and steps stay as they are, `hitch tune --scenario draft` searches them";

/// Runs the command.
///
/// # Errors
/// If the model or the calibration is invalid, or the result cannot be written.
pub fn run(args: &Args) -> Result<(), Error> {
    let mut inputs = read_files(&args.model, args.calibration.as_ref());
    inputs.extend(args.draft.clone());
    let outputs = Outputs::check([Some(args.out.as_path())], &inputs)?;
    let model = hitch_model_file::named(&args.model)?;
    let base = calibration(args.calibration.as_ref())?;
    let refused = |error| Error::Usage(format!("{}: {error}", args.model));
    let mut calibration = calibrate(&model, &base).map_err(refused)?;
    let mut of_draft = Vec::new();
    if let Some(path) = &args.draft {
        (calibration, of_draft) =
            with_draft(&model, &calibration, &read_working(path)?).map_err(refused)?;
        of_draft.push(NOT_FROM_A_DRAFT.to_owned());
    }
    hitch_output::write_file(&args.out, calibration_file::write(&calibration).as_bytes())?;
    let mut text = format!("{} -> {}\n", model.name, args.out.display());
    for (name, table, before) in [
        ("lift", &calibration.lift, &base.lift),
        ("lower", &calibration.lower, &base.lower),
    ] {
        let line = format!("{name}: {} (was {})", described(table), described(before));
        text += &format!("{}\n", indented(&line, 2));
    }
    for line in carried::lines(&model, &base, &calibration)
        .into_iter()
        .chain(of_draft)
    {
        text += &format!("{}\n", indented(&line, 2));
    }
    outputs.say(|| text)
}

fn described(table: &ValveTable) -> String {
    format!(
        "threshold {:.3} A, {:.2} l/min at most, {} points",
        f64::from(table.threshold().0) * 1e-3,
        f64::from(table.saturation().0) * 60e-6,
        table.used().len(),
    )
}
