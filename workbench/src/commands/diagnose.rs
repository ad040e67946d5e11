//! `hitch diagnose`: ranks missing physical effects.

use std::path::PathBuf;

use hitch_campaign::Campaign;
use hitch_identification::data::experiment::Experiment;
use hitch_identification::data::problem::Problem;
use hitch_identification::explanation::explain::{diagnose, fit_base};

use crate::error::Error;
use crate::explanation::Diagnosis;
use crate::model_arg::ModelArg;
use crate::output::JsonArg;
use crate::outputs::{Outputs, campaign_files};
use crate::progress::Progress;

/// Arguments of `hitch diagnose`.
#[derive(Debug, clap::Args)]
#[command(after_help = "Example: hitch diagnose lab-a --model dynamic")]
pub struct Args {
    /// Folder of the campaign
    campaign: PathBuf,
    #[command(flatten)]
    model: ModelArg,
    #[command(flatten)]
    json: JsonArg,
}

/// Runs the command.
///
/// # Errors
/// If the campaign or the model file is invalid, or the result cannot be written.
pub fn run(args: &Args) -> Result<(), Error> {
    let mut inputs = campaign_files(&args.campaign);
    inputs.push(args.model.file());
    let outputs = Outputs::check([args.json.target()], &inputs)?;
    let model = args.model.load()?;
    let campaign = Campaign::load_with(&args.campaign, model.linkage())?;
    let progress = Progress::start(format!("fitting {} to {}", model.name, campaign.name));
    let experiment = Experiment::new(&campaign, &model);
    let base = fit_base(Problem::new(&experiment, &model));
    let found = diagnose(Problem::new(&experiment, &model), base, &|what| {
        progress.say(format!("trying {what}"))
    });
    let shown = Diagnosis::new(&experiment, &model, &found);
    drop(progress);
    outputs.tell(&args.json, &shown, || shown.to_string())
}
