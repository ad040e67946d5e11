//! `hitch` without a command: from measurement to motion on the demonstration campaign.

use std::path::PathBuf;

use hitch_campaign::Campaign;
use hitch_identification::data::experiment::Experiment;
use hitch_identification::search::options::Options;
use hitch_plant::Model;

use hitch_output::error::Error;
use hitch_output::progress::Progress;
use hitch_output::targets::Outputs;
use hitch_output::text::{colour, indented, joined, wrapped};
use hitch_results::arguments::demonstration;
use hitch_results::closed_loop::Scenario;
use hitch_results::closed_loop::rebuild::Rebuild;
use hitch_results::comparison::Comparison;
use hitch_results::explanation::Found;
use hitch_results::report::main_page;

/// Number of worst cells that are listed.
const NAMED_CELLS: usize = 3;

/// Arguments of `hitch` without a command.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Without a command: write the report to this file
    #[arg(long, value_name = "FILE.html", default_value = "hitch-report.html")]
    report: PathBuf,
}

/// Runs the main job.
///
/// # Errors
/// If the report cannot be written.
pub fn run(args: &Args) -> Result<(), Error> {
    let outputs = Outputs::check([Some(args.report.as_path())], &[])?;
    let campaign = demonstration::campaign()?;
    let model = hitch_model_file::nominal();
    outputs.say(|| compared(&campaign, &model))?;
    let found = Found::new(
        Experiment::new(&campaign, &model),
        model,
        Options::default(),
        &|_| {},
    );
    outputs.say(|| explained(&found))?;
    let progress = Progress::start("running the closed loop with both valve maps");
    let rebuild = Rebuild::new(&found, Scenario::Moves)?;
    drop(progress);
    outputs.say(|| format!("\n{}", rebuild.text()))?;
    hitch_output::write_file(&args.report, main_page::page(&found, &rebuild).as_bytes())?;
    outputs.say(|| {
        let report = args.report.display();
        format!("\nReport: {report}\nInteractive page: hitch serve\n")
    })
}

fn compared(campaign: &Campaign, model: &Model) -> String {
    let (comparison, _) = Comparison::new(campaign, model);
    let head = format!(
        "Measured: {}, {} runs. Largest errors of the model {}:",
        campaign.name,
        campaign.runs.len(),
        model.name
    );
    let mut text = format!("{}\n", wrapped(&head));
    for cell in comparison.worst_cells().into_iter().take(NAMED_CELLS) {
        text += &format!(
            "  {}, {}: {:.1} sigma\n",
            cell.channel, cell.part, cell.error
        );
    }
    text
}

fn explained(found: &Found) -> String {
    let shown = &found.shown;
    let mut text = String::from("\nMissing:\n");
    for step in &shown.steps {
        let line = format!("{}: {}", step.name(), joined(&step.parameters, ", "));
        text += &format!("{}\n", indented(&line, 2));
    }
    let head = &shown.head;
    let held_out = shown.steps.last().map(|step| step.held_out_after);
    let held_out = held_out
        .filter(|error| !error.is_nan())
        .map(|error| format!(" ({error:.2} on held-out runs)"));
    let line = format!(
        "the error falls from {:.2} to {:.2} sigma{}: {}",
        head.error_before,
        head.error_after,
        held_out.unwrap_or_default(),
        colour::verdict(head.verdict)
    );
    format!("{text}{}\n", indented(&line, 2))
}
