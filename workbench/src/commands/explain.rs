//! `hitch explain`: finds and adds missing effects until no further one is significant.

use std::path::{Path, PathBuf};

use hitch_campaign::Campaign;
use hitch_identification::data::experiment::Experiment;
use hitch_identification::data::problem::Problem;
use hitch_identification::estimate::Estimate;
use hitch_identification::estimation::baseline::Baseline;
use hitch_identification::search::subset::{Accuracy, Options};
use hitch_plant::Model;

use crate::commands::fleet::FleetArgs;
use crate::error::Error;
use crate::explanation::{Found, rebuilt};
use crate::model_arg::ModelArg;
use crate::next_command;
use crate::output::{self, JsonArg};
use crate::outputs::{Outputs, campaign_files};
use crate::progress::Progress;
use crate::report::explanation_page;
use crate::search_args::SearchArgs;

/// Arguments of `hitch explain`.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Examples:\n  hitch explain lab-a --out lab-a.toml --report lab-a.html\n  hitch explain fleet/* --budget 60 --jsonl fleet.jsonl --resume"
)]
pub struct Args {
    /// Folders of the campaigns; several with --jsonl
    #[arg(required = true, value_name = "CAMPAIGN")]
    campaigns: Vec<PathBuf>,
    #[command(flatten)]
    model: ModelArg,
    /// Folder of the campaign that the model was adopted from: what the model leaves on it is subtracted, so that only
    /// changes since then remain
    #[arg(long, value_name = "CAMPAIGN")]
    baseline: Option<PathBuf>,
    /// Write the model with the added effects to this file, updated during the search with the best model so far
    #[arg(long, value_name = "MODEL.toml")]
    out: Option<PathBuf>,
    /// Write a report to this file: self-contained HTML
    #[arg(long, value_name = "FILE.html")]
    report: Option<PathBuf>,
    #[command(flatten)]
    search: SearchArgs,
    #[command(flatten)]
    json: JsonArg,
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
        ("--out", args.out.is_some()),
    ];
    match args.fleet.single(&args.campaigns, &others)? {
        Some(campaign) => one(args, campaign),
        None => many(args),
    }
}

fn many(args: &Args) -> Result<(), Error> {
    let model = args.model.load()?;
    let baseline = baseline(args, &model)?;
    let mut inputs = args.baseline.as_deref().map_or(Vec::new(), campaign_files);
    inputs.push(args.model.file());
    args.fleet.run(&args.campaigns, &inputs, |folder| {
        let campaign = Campaign::load_with(folder, model.linkage())?;
        let model = args.model.nearer(model.clone(), &campaign);
        // The time limit is that of a campaign: it starts here.
        let (experiment, options) = posed(args, &campaign, &model, baseline.as_ref());
        let progress = Progress::hidden();
        let found = Found::with_progress(experiment, model, options, &|_| {}, &progress);
        Ok(found.shown)
    })
}

/// What the model leaves on the campaign of `--baseline`.
fn baseline(args: &Args, model: &Model) -> Result<Option<Baseline>, Error> {
    let Some(folder) = &args.baseline else {
        return Ok(None);
    };
    let campaign = Campaign::load_with(folder, model.linkage())?;
    let experiment = Experiment::new(&campaign, model);
    Ok(Some(Baseline::new(Problem::new(&experiment, model))))
}

/// A campaign less the baseline, and the options of its search.
fn posed<'a>(
    args: &Args,
    campaign: &Campaign,
    model: &Model,
    baseline: Option<&Baseline>,
) -> (Experiment, Options<'a>) {
    let (experiment, options) = (Experiment::new(campaign, model), args.search.options());
    match baseline {
        None => (experiment, options),
        Some(baseline) => {
            let options = Options {
                constants: Accuracy::Adopted,
                ..options
            };
            (baseline.subtracted_from(experiment), options)
        }
    }
}

fn one(args: &Args, folder: &Path) -> Result<(), Error> {
    let mut inputs = campaign_files(folder);
    inputs.push(args.model.file());
    inputs.extend(args.baseline.as_deref().map_or(Vec::new(), campaign_files));
    let wanted = [
        args.out.as_deref(),
        args.report.as_deref(),
        args.json.target(),
    ];
    let outputs = Outputs::check(wanted, &inputs)?;
    let (model, campaign) = args.model.load_for(folder)?;
    // The best result so far is on disk if the search is interrupted.
    let out = args.out.as_deref().filter(|path| !output::is_stdout(path));
    let base = model.clone();
    let improved = |estimate: &Estimate| {
        if let Some(path) = out {
            let partial = rebuilt(&base, estimate, output::stem(path));
            // A fault is reported by the last write.
            let _ = output::write_file(path, hitch_model_file::to_toml(&partial).as_bytes());
        }
    };
    let baseline = baseline(args, &model)?;
    let (experiment, options) = posed(args, &campaign, &model, baseline.as_ref());
    let found = Found::new(experiment, model, options, &improved);
    if let Some(path) = &args.out {
        output::write_file(
            path,
            hitch_model_file::to_toml(&found.rebuilt(output::stem(path))).as_bytes(),
        )?;
    }
    if let Some(path) = &args.report {
        output::write_file(path, explanation_page::page(&found).as_bytes())?;
    }
    outputs.tell(&args.json, &found.shown, || {
        let next = next_command::after_explanation(out, folder, &args.model);
        format!("{}\n{next}", found.shown)
    })
}
