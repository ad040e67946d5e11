//! `hitch paper`: compares the paper's tables and figures with this model.
use crate::error::Error;
use crate::model_arg::ModelArg;
use crate::output::JsonArg;
use crate::outputs::Outputs;
use crate::paper::Paper;
use crate::progress::Progress;

/// Arguments of `hitch paper`.
#[derive(Debug, clap::Args)]
#[command(after_help = "Example: hitch paper --json - | jq .figure_12.lifting")]
pub struct Args {
    #[command(flatten)]
    model: ModelArg,
    #[command(flatten)]
    json: JsonArg,
}

/// Runs the command.
///
/// # Errors
/// If the model file is invalid or the output cannot be written.
pub fn run(args: &Args) -> Result<(), Error> {
    let outputs = Outputs::check([args.json.target()], &[args.model.file()])?;
    let model = args.model.load()?;
    let progress = Progress::start("computing the paper's tables and figures");
    let paper = Paper::of(&model, &progress);
    drop(progress);
    outputs.tell(&args.json, &paper, || paper.to_string())
}
