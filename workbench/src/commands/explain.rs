//! `hitch explain`: finds and adds missing effects until no further one is significant.

use std::path::PathBuf;

use hitch_campaign::Campaign;
use hitch_plant::AddedEffect;

use crate::error::Error;
use crate::explanation::{Found, rebuilt};
use crate::model_arg::ModelArg;
use crate::output::{self, JsonArg};
use crate::outputs::{Outputs, campaign_files};
use crate::report::explanation_page;
use crate::search_args::SearchArgs;

/// Arguments of `hitch explain`.
#[derive(Debug, clap::Args)]
#[command(after_help = "Example: hitch explain lab-a --out lab-a.toml --report lab-a.html")]
pub struct Args {
    /// Folder of the campaign
    campaign: PathBuf,
    #[command(flatten)]
    model: ModelArg,
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
}

/// Runs the command.
///
/// # Errors
/// If the campaign or the model file is invalid, or a result cannot be written.
pub fn run(args: &Args) -> Result<(), Error> {
    let mut inputs = campaign_files(&args.campaign);
    inputs.push(args.model.file());
    let wanted = [
        args.out.as_deref(),
        args.report.as_deref(),
        args.json.target(),
    ];
    let outputs = Outputs::check(wanted, &inputs)?;
    let model = args.model.load()?;
    let campaign = Campaign::load_with(&args.campaign, model.linkage())?;
    // The best result so far is on disk if the search is interrupted.
    let out = args.out.as_deref().filter(|path| !output::is_stdout(path));
    let base = model.clone();
    let improved = |effects: &[AddedEffect]| {
        if let Some(path) = out {
            let partial = rebuilt(&base, effects, output::stem(path));
            // A fault is reported by the last write.
            let _ = output::write_file(path, hitch_model_file::to_toml(&partial).as_bytes());
        }
    };
    let found = Found::new(&campaign, model, args.search.options(), &improved);
    if let Some(path) = &args.out {
        output::write_file(
            path,
            hitch_model_file::to_toml(&found.rebuilt(output::stem(path))).as_bytes(),
        )?;
    }
    if let Some(path) = &args.report {
        output::write_file(path, explanation_page::page(&found).as_bytes())?;
    }
    outputs.tell(&args.json, &found.shown, || found.shown.to_string())
}
