//! `hitch adopt`: from a data sheet to a model of one machine.

use std::path::PathBuf;

use hitch_identification::search::options::{Accuracy, Options};

use hitch_output::JsonArg;
use hitch_output::error::Error;
use hitch_output::targets::{Outputs, campaign_files};
use hitch_output::text::{shell_word, wrapped};
use hitch_results::arguments::model::ModelArg;
use hitch_results::arguments::search::SearchArgs;
use hitch_results::arguments::tolerances::ToleranceArgs;
use hitch_results::explanation::{Base, Found, Posed, saving};
use hitch_results::report::explanation_page;

/// Arguments of `hitch adopt`.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Example: hitch adopt may --model data-sheet.toml --out tractor.toml --hold cylinder.bore_mm\n\n\
    The constants are fitted within the tolerances of data sheets, together with the effects that the machine has. \
    Take a campaign of the machine in good order: `hitch changes` and `hitch explain --baseline` then find what has changed since."
)]
pub struct Args {
    /// Folder of the campaign
    campaign: PathBuf,
    #[command(flatten)]
    model: ModelArg,
    /// Write the model of the machine to this file, updated during the search with the best model so far
    #[arg(long, value_name = "MACHINE.toml")]
    out: PathBuf,
    #[command(flatten)]
    tolerances: ToleranceArgs,
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
/// If the campaign or the model file is invalid, a constant is not known, or a result cannot be written.
pub fn run(args: &Args) -> Result<(), Error> {
    let mut inputs = campaign_files(&args.campaign);
    inputs.push(args.model.file());
    let wanted = [
        Some(args.out.as_path()),
        args.report.as_deref(),
        args.json.target(),
    ];
    let outputs = Outputs::check(wanted, &inputs)?;
    let sheet = Base::Alone(&args.model, args.model.load()?);
    let Posed {
        model, experiment, ..
    } = sheet.posed(&args.campaign)?;
    let (tolerances, model) = args.tolerances.applied_to(model)?;
    let improved = saving(&model, Some(&args.out));
    let options = Options {
        constants: Accuracy::DataSheet,
        tolerances: Some(&tolerances),
        ..args.search.options()
    };
    let found = Found::new(experiment, model, options, &improved);
    found.write_model(Some(&args.out))?;
    hitch_output::write_if(args.report.as_ref(), || explanation_page::page(&found))?;
    outputs.tell(&args.json, &found.shown, || {
        let next = format!(
            "Next, after a change: hitch explain NEW --model {} --baseline {}",
            shell_word(&args.out),
            shell_word(&args.campaign)
        );
        format!("{}\n{}", found.shown, wrapped(&next))
    })
}
