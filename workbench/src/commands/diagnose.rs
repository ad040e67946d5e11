//! `hitch diagnose`: ranks missing physical effects.

use std::path::PathBuf;

use hitch_identification::data::problem::Problem;
use hitch_identification::explanation::diagnosis::diagnose;
use hitch_identification::explanation::explain::fit_base;

use crate::commands::next_folder::NextFolder;
use hitch_output::JsonArg;
use hitch_output::error::Error;
use hitch_output::progress::Progress;
use hitch_output::targets::{Outputs, campaign_files};
use hitch_results::arguments::baseline::BaselineArg;
use hitch_results::arguments::model::ModelArg;
use hitch_results::arguments::next_command::{self, Standing};
use hitch_results::explanation::{Base, Diagnosis, Head, Posed};
use hitch_results::report::diagnosis_page;

/// Arguments of `hitch diagnose`.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Example: hitch diagnose lab-a --model dynamic --report lab-a.html --next experiment"
)]
pub struct Args {
    /// Folder of the campaign
    campaign: PathBuf,
    #[command(flatten)]
    model: ModelArg,
    #[command(flatten)]
    baseline: BaselineArg,
    #[command(flatten)]
    json: JsonArg,
    /// Write a report to this file: self-contained HTML
    #[arg(long, value_name = "FILE.html")]
    report: Option<PathBuf>,
    #[command(flatten)]
    next: NextFolder,
}

/// Runs the command.
///
/// # Errors
/// If the campaign or the model file is invalid, or the result cannot be written.
pub fn run(args: &Args) -> Result<(), Error> {
    let mut inputs = campaign_files(&args.campaign);
    inputs.push(args.model.file());
    inputs.extend(args.baseline.files());
    let outputs = Outputs::check([args.json.target(), args.report.as_deref()], &inputs)?;
    args.next.check()?;
    let Posed {
        model,
        campaign,
        experiment,
    } = Base::load(&args.model, &args.baseline)?.posed(&args.campaign)?;
    let progress = Progress::start(format!("fitting {} to {}", model.name, campaign.name));
    let base = fit_base(Problem::new(&experiment, &model));
    let found = diagnose(Problem::new(&experiment, &model), base, &|what| {
        progress.say(format!("trying {what}"))
    });
    let shown = Diagnosis::new(&experiment, &model, &found);
    drop(progress);
    hitch_output::write_if(args.report.as_ref(), || {
        diagnosis_page::page(&shown, &found, &experiment, &model)
    })?;
    let written = args.next.write(&shown.next)?;
    outputs.tell(&args.json, &shown, || {
        let Head {
            unsuitable_base,
            verdict,
            ..
        } = shown.head;
        let standing = match (unsuitable_base, verdict) {
            (true, _) => Standing::UnsuitableBase,
            (false, "nothing-missing") => Standing::Adequate,
            (false, _) => Standing::Inadequate,
        };
        let next = next_command::next(standing, &args.campaign, &args.model, &args.baseline);
        format!("{shown}\n{written}{next}")
    })
}
