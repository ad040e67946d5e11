//! `hitch explain`: finds and adds missing effects until no further one is significant.

use std::path::{Path, PathBuf};

use hitch_measurement::check;

use crate::commands::fleet::FleetArgs;
use crate::commands::next_folder::NextFolder;
use hitch_output::JsonArg;
use hitch_output::error::Error;
use hitch_output::progress::Progress;
use hitch_output::targets::{Outputs, campaign_files};
use hitch_results::arguments::baseline::BaselineArg;
use hitch_results::arguments::model::ModelArg;
use hitch_results::arguments::next_command;
use hitch_results::arguments::search::SearchArgs;
use hitch_results::explanation::{Base, Found, Posed, saving};
use hitch_results::measurement;
use hitch_results::report::explanation_page;

/// Arguments of `hitch explain`.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Examples:\n  hitch explain lab-a --out lab-a.toml --report lab-a.html --next experiment\n  hitch explain fleet/* --budget 60 --jsonl fleet.jsonl --resume"
)]
pub struct Args {
    /// Folders of the campaigns; several with --jsonl
    #[arg(required = true, value_name = "CAMPAIGN")]
    campaigns: Vec<PathBuf>,
    #[command(flatten)]
    model: ModelArg,
    #[command(flatten)]
    baseline: BaselineArg,
    /// Write the model with the added effects to this file, updated during the search with the best model so far
    #[arg(long, value_name = "MODEL.toml")]
    out: Option<PathBuf>,
    /// Write a report to this file: self-contained HTML
    #[arg(long, value_name = "FILE.html")]
    report: Option<PathBuf>,
    #[command(flatten)]
    next: NextFolder,
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
        ("--next", args.next.is_given()),
    ];
    match args.fleet.single(&args.campaigns, &others)? {
        Some(campaign) => one(args, campaign),
        None => many(args),
    }
}

fn many(args: &Args) -> Result<(), Error> {
    let base = Base::load(&args.model, &args.baseline)?;
    let mut inputs = args.baseline.files();
    inputs.push(args.model.file());
    args.fleet.run(&args.campaigns, &inputs, |folder| {
        // The time limit is that of a campaign: it starts here.
        let options = args.search.options();
        let Posed {
            model, experiment, ..
        } = base.posed(folder)?;
        let progress = Progress::hidden();
        let found = Found::with_progress(experiment, model, options, &|_| {}, &progress);
        Ok(found.shown)
    })
}

fn one(args: &Args, folder: &Path) -> Result<(), Error> {
    let mut inputs = campaign_files(folder);
    inputs.push(args.model.file());
    inputs.extend(args.baseline.files());
    let wanted = [
        args.out.as_deref(),
        args.report.as_deref(),
        args.json.target(),
    ];
    let outputs = Outputs::check(wanted, &inputs)?;
    args.next.check()?;
    let options = args.search.options();
    let Posed {
        model,
        campaign,
        experiment,
    } = Base::load(&args.model, &args.baseline)?.posed(folder)?;
    let faults = measurement::text(&check(&campaign, Some(&model)));
    let improved = saving(&model, args.out.as_deref());
    let found = Found::new(experiment, model, options, &improved);
    found.write_model(args.out.as_ref())?;
    hitch_output::write_if(args.report.as_ref(), || explanation_page::page(&found))?;
    let written = args.next.write(&found.shown.next)?;
    outputs.tell(&args.json, &found.shown, || {
        let out = args
            .out
            .as_deref()
            .filter(|path| !hitch_output::is_stdout(path));
        let next = next_command::after_explanation(out, folder, &args.model, &args.baseline);
        format!("{faults}{}\n{written}{next}", found.shown)
    })
}
