//! `hitch model fit`: fits the constants of the base model to a campaign.

use std::path::PathBuf;

use hitch_campaign::Campaign;
use hitch_identification::base::fit_base_model;
use hitch_identification::data::experiment::Experiment;

use hitch_output::JsonArg;
use hitch_output::error::Error;
use hitch_output::progress::Progress;
use hitch_output::targets::{Outputs, campaign_files};
use hitch_results::arguments::model::ModelArg;
use hitch_results::arguments::tolerances::ToleranceArgs;
use hitch_results::base_model::fit::ShownBaseFit;
use hitch_results::report::fit_page;

/// Arguments of `hitch model fit`.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Example: hitch model fit lab-a --model my-hitch.toml --out fitted.toml --report fit.html\n\n\
    Every constant has a prior: the declared value with the tolerance of data sheets (flow curves 20 %, pressures 10 % \
    to 20 %, bore 2 %, masses 10 %). What the campaign does not determine stays at its declared value and is named. A constant \
    that you have measured is kept with --hold."
)]
pub struct Args {
    /// Folder of the campaign
    campaign: PathBuf,
    #[command(flatten)]
    model: ModelArg,
    /// Write the fitted model to this file
    #[arg(long, value_name = "FILE.toml")]
    out: PathBuf,
    #[command(flatten)]
    tolerances: ToleranceArgs,
    #[command(flatten)]
    json: JsonArg,
    /// Write a report to this file: flow curves and constants with intervals, runs before and after
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
    let wanted = [
        Some(args.out.as_path()),
        args.report.as_deref(),
        args.json.target(),
    ];
    let outputs = Outputs::check(wanted, &inputs)?;
    let (tolerances, model) = args.tolerances.applied_to(args.model.load()?)?;
    let campaign = Campaign::load_with(&args.campaign, model.linkage())?;
    let progress = Progress::start(format!("fitting {} to {}", model.name, campaign.name));
    let experiment = Experiment::new(&campaign, &model);
    let mut fit = fit_base_model(&experiment, &model, &tolerances, &|what| progress.say(what));
    drop(progress);
    fit.model.name = hitch_output::stem(&args.out);
    hitch_output::write_file(&args.out, hitch_model_file::to_toml(&fit.model).as_bytes())?;
    let next = format!(
        "hitch explain {} --model {}",
        args.campaign.display(),
        args.out.display()
    );
    let shown = ShownBaseFit::new(&experiment, &model, &fit, next);
    hitch_output::write_if(args.report.as_ref(), || {
        fit_page::page(&fit_page::Shown {
            experiment: &experiment,
            declared: &model,
            fit: &fit,
            told: &shown,
        })
    })?;
    outputs.tell(&args.json, &shown, || shown.to_string())
}
