//! `hitch compare`: compares a model with measurements.

use std::path::PathBuf;

use hitch_campaign::Campaign;

use crate::comparison::Comparison;
use crate::error::Error;
use crate::model_arg::ModelArg;
use crate::output::{self, JsonArg};
use crate::outputs::{Outputs, campaign_files};
use crate::progress::Progress;
use crate::report::comparison_page;

/// Arguments of `hitch compare`.
#[derive(Debug, clap::Args)]
#[command(after_help = "Example: hitch compare lab-a --model dynamic --report lab-a.html")]
pub struct Args {
    /// Folder of the campaign
    campaign: PathBuf,
    #[command(flatten)]
    model: ModelArg,
    #[command(flatten)]
    json: JsonArg,
    /// Write a report to this file: self-contained HTML
    #[arg(long, value_name = "FILE.html")]
    report: Option<PathBuf>,
}

/// Runs the command.
///
/// # Errors
/// If the campaign or the model file is invalid, or a result cannot be written.
pub fn run(args: &Args) -> Result<(), Error> {
    let mut inputs = campaign_files(&args.campaign);
    inputs.push(args.model.file());
    let outputs = Outputs::check([args.report.as_deref(), args.json.target()], &inputs)?;
    let model = args.model.load()?;
    let campaign = Campaign::load_with(&args.campaign, model.linkage())?;
    let progress = Progress::start(format!("comparing {} with {}", model.name, campaign.name));
    let (comparison, evaluated) = Comparison::new(&campaign, &model);
    drop(progress);
    if let Some(path) = &args.report {
        let page = comparison_page::page(&comparison, &evaluated, &model);
        output::write_file(path, page.as_bytes())?;
    }
    outputs.tell(&args.json, &comparison, || comparison.to_string())
}
