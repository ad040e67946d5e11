//! `hitch compare`: compares a model with measurements.

use std::path::{Path, PathBuf};

use hitch_campaign::Campaign;
use hitch_identification::adequacy::unsuitable_base::is_unsuitable;

use crate::commands::fleet::FleetArgs;
use hitch_output::JsonArg;
use hitch_output::error::Error;
use hitch_output::progress::Progress;
use hitch_output::targets::{Outputs, campaign_files};
use hitch_results::arguments::baseline::BaselineArg;
use hitch_results::arguments::model::ModelArg;
use hitch_results::arguments::next_command::{self, Standing};
use hitch_results::comparison::Comparison;
use hitch_results::report::comparison_page;

/// Arguments of `hitch compare`.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Examples:\n  hitch compare lab-a --model dynamic --report lab-a.html\n  hitch compare fleet/* --jsonl fleet.jsonl"
)]
pub struct Args {
    /// Folders of the campaigns; several with --jsonl
    #[arg(required = true, value_name = "CAMPAIGN")]
    campaigns: Vec<PathBuf>,
    #[command(flatten)]
    model: ModelArg,
    #[command(flatten)]
    json: JsonArg,
    /// Write a report to this file: self-contained HTML
    #[arg(long, value_name = "FILE.html")]
    report: Option<PathBuf>,
    #[command(flatten)]
    fleet: FleetArgs,
}

/// Runs the command.
///
/// # Errors
/// If the campaign or the model file is invalid, or a result cannot be written.
pub fn run(args: &Args) -> Result<(), Error> {
    let others = [
        ("--json", args.json.target().is_some()),
        ("--report", args.report.is_some()),
    ];
    match args.fleet.single(&args.campaigns, &others)? {
        Some(campaign) => one(args, campaign),
        None => many(args),
    }
}

fn many(args: &Args) -> Result<(), Error> {
    let model = args.model.load()?;
    args.fleet
        .run(&args.campaigns, &[args.model.file()], |folder| {
            let campaign = Campaign::load_with(folder, model.linkage())?;
            Ok(Comparison::new(&campaign, &model).0)
        })
}

fn one(args: &Args, folder: &Path) -> Result<(), Error> {
    let mut inputs = campaign_files(folder);
    inputs.push(args.model.file());
    let outputs = Outputs::check([args.report.as_deref(), args.json.target()], &inputs)?;
    let model = args.model.load()?;
    let campaign = Campaign::load_with(folder, model.linkage())?;
    let progress = Progress::start(format!("comparing {} with {}", model.name, campaign.name));
    let (comparison, evaluated) = Comparison::new(&campaign, &model);
    drop(progress);
    hitch_output::write_if(args.report.as_ref(), || {
        comparison_page::page(&comparison, &evaluated, &model)
    })?;
    let fit = &evaluated.fit;
    let standing = match comparison.worst_cells().is_empty() {
        true => Standing::Adequate,
        false if is_unsuitable(&evaluated.experiment, fit, fit) => Standing::UnsuitableBase,
        false => Standing::Inadequate,
    };
    outputs.tell(&args.json, &comparison, || {
        let next = next_command::next(standing, folder, &args.model, &BaselineArg::default());
        format!("{comparison}\n{next}")
    })
}
