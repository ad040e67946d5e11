//! `hitch summary`: what the lines of many campaigns show together.

use std::path::PathBuf;

use hitch_output::JsonArg;
use hitch_output::error::Error;
use hitch_output::targets::Outputs;
use hitch_results::fleet_summary::FleetSummary;
use hitch_results::fleet_summary::read::read;
use hitch_results::report::fleet_page;

/// Arguments of `hitch summary`.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Example:\n  hitch explain fleet/*/ --jsonl fleet.jsonl\n  hitch summary fleet.jsonl --report fleet.html"
)]
pub struct Args {
    /// Files that `hitch explain` or `hitch changes` wrote with --jsonl
    #[arg(required = true, value_name = "LINES.jsonl")]
    lines: Vec<PathBuf>,
    #[command(flatten)]
    json: JsonArg,
    /// Write a report to this file, machine by effect: self-contained HTML
    #[arg(long, value_name = "FILE.html")]
    report: Option<PathBuf>,
}

/// Runs the command.
///
/// # Errors
/// If a file is not one of lines, or the result cannot be written.
pub fn run(args: &Args) -> Result<(), Error> {
    let outputs = Outputs::check([args.json.target(), args.report.as_deref()], &args.lines)?;
    let mut lines = Vec::new();
    for path in &args.lines {
        lines.extend(read(path)?);
    }
    let summary = FleetSummary::of(lines);
    hitch_output::write_if(args.report.as_ref(), || fleet_page::page(&summary))?;
    outputs.tell(&args.json, &summary, || summary.to_string())
}
