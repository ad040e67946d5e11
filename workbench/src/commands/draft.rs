//! `hitch draft`: what a draft campaign says of implement, soil and sensors.

use std::path::PathBuf;

use hitch_draft::fit::fit;
use hitch_draft::manifest::Campaign;
use hitch_input::input_error::InputError;

use hitch_output::JsonArg;
use hitch_output::error::Error;
use hitch_output::targets::{Outputs, campaign_files};
use hitch_results::draft::{DraftResult, write_example};
use hitch_results::report::draft_page;

/// Arguments of `hitch draft`.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Example:\n  hitch draft field --example 1\n  hitch draft field --report draft.html\n\ncampaign.toml and logs: docs/field.md"
)]
pub struct Args {
    /// Folder with campaign.toml and a log per run: time, speed, depth and draft, with units in the headers
    #[arg(value_name = "FOLDER")]
    folder: PathBuf,
    /// Write an example into the new folder FOLDER instead: a campaign of a plough drawn from the model of the field with this
    /// seed
    #[arg(long, value_name = "SEED", conflicts_with_all = ["target", "report"])]
    example: Option<u64>,
    #[command(flatten)]
    json: JsonArg,
    /// Write a report to this file: self-contained HTML
    #[arg(long, value_name = "FILE.html")]
    report: Option<PathBuf>,
}

/// Runs the command.
///
/// # Errors
/// If the campaign is invalid, or a result cannot be written.
pub fn run(args: &Args) -> Result<(), Error> {
    if let Some(seed) = args.example {
        write_example(&args.folder, seed)?;
        return hitch_output::print(&format!("{}\n", args.folder.display()));
    }
    let inputs = campaign_files(&args.folder);
    let outputs = Outputs::check([args.json.target(), args.report.as_deref()], &inputs)?;
    let campaign = Campaign::load(&args.folder)?;
    let fit = fit(&campaign.machine, &campaign.runs).ok_or_else(|| {
        let what = "no run is in the soil: all depths are below 3 cm, or the tractor stands";
        InputError::of_file(
            &args.folder,
            what,
            "check the columns of depth and speed, and their units",
        )
    })?;
    let result = DraftResult::of(&campaign, fit);
    hitch_output::write_if(args.report.as_ref(), || draft_page::page(&result))?;
    outputs.tell(&args.json, &result, || result.to_string())
}
