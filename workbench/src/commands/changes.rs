//! `hitch changes`: compares two campaigns of one machine, or of two machines of a series.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use hitch_campaign::Campaign;
use hitch_identification::data::experiment::Experiment;
use hitch_identification::search::options::Options;
use hitch_plant::Model;
use schemars::JsonSchema;
use serde::Serialize;

use crate::commands::fleet::FleetArgs;
use hitch_output::JsonArg;
use hitch_output::error::Error;
use hitch_output::progress::Progress;
use hitch_output::targets::{Outputs, campaign_files};
use hitch_output::text::colour::sigma;
use hitch_output::text::wrapped;
use hitch_results::arguments::model::ModelArg;
use hitch_results::arguments::search::SearchArgs;
use hitch_results::explanation::{Explanation, Found, Since};
use hitch_results::report::changes_page;

/// Arguments of `hitch changes`.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Examples:\n  hitch changes may november --model tractor.toml --out november.toml\n  hitch changes series/first series/* --jsonl series.jsonl"
)]
pub struct Args {
    /// Folder of the reference campaign
    baseline: PathBuf,
    /// Folders of the campaigns that are compared with it; several with --jsonl
    #[arg(required = true, value_name = "NEW")]
    new: Vec<PathBuf>,
    #[command(flatten)]
    model: ModelArg,
    /// Write the model of the new campaign to this file
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

/// Result of `hitch changes`: both explanations.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Changes {
    /// Effects that the model lacks on the reference campaign.
    baseline: Explanation,
    /// Changes since: the steps from the model of the reference campaign to a model of the new campaign.
    new: Explanation,
}

/// Runs the command.
///
/// # Errors
/// If a campaign or the model file is invalid, or a result cannot be written.
pub fn run(args: &Args) -> Result<(), Error> {
    let others = [
        ("--json", args.json.target().is_some()),
        ("--report", args.report.is_some()),
        ("--out", args.out.is_some()),
    ];
    match args.fleet.single(&args.new, &others)? {
        Some(new) => one(args, new),
        None => many(args),
    }
}

/// Compares each campaign with the model of the reference campaign, which is explained once.
fn many(args: &Args) -> Result<(), Error> {
    let mut inputs = campaign_files(&args.baseline);
    inputs.push(args.model.file());
    let model = args.model.load()?;
    let linkage = model.linkage().clone();
    let baseline = Campaign::load_with(&args.baseline, &linkage)?;
    let model = args.model.nearer(model, &baseline);
    // Only a call that has work to do explains it.
    let explained = OnceLock::new();
    args.fleet.run(&args.new, &inputs, |folder| {
        let new = Campaign::load_with(folder, &linkage)?;
        let adopted = explained.get_or_init(|| {
            let options = args.search.options();
            Adopted::new(&baseline, &model, options, &Progress::hidden())
        });
        Ok(adopted
            .changes(&new, args.search.options(), &Progress::hidden())
            .0)
    })
}

fn one(args: &Args, new: &Path) -> Result<(), Error> {
    let mut inputs = campaign_files(&args.baseline);
    inputs.extend(campaign_files(new));
    inputs.push(args.model.file());
    let wanted = [
        args.out.as_deref(),
        args.report.as_deref(),
        args.json.target(),
    ];
    let outputs = Outputs::check(wanted, &inputs)?;
    let model = args.model.load()?;
    let load = |folder| Campaign::load_with(folder, model.linkage());
    let [baseline, new] = [args.baseline.as_path(), new].map(load);
    let (baseline, new) = (baseline?, new?);
    let model = args.model.nearer(model, &baseline);
    let progress = |campaign: &Campaign| Progress::start(format!("explaining {}", campaign.name));
    let options = args.search.options();
    let adopted = Adopted::new(&baseline, &model, options, &progress(&baseline));
    let (changes, new) = adopted.changes(&new, args.search.options(), &progress(&new));
    new.write_model(args.out.as_ref())?;
    hitch_output::write_if(args.report.as_ref(), || {
        changes_page::page(&changes.baseline, &new)
    })?;
    outputs.tell(&args.json, &changes, || changes.to_string())
}

/// The explanation of a reference campaign, and the model that was adopted from it.
struct Adopted {
    found: Explanation,
    since: Since,
}

impl Adopted {
    /// Explains the reference campaign.
    fn new(campaign: &Campaign, model: &Model, options: Options<'_>, progress: &Progress) -> Self {
        let experiment = Experiment::new(campaign, model);
        let found = Found::with_progress(experiment, model.clone(), options, &|_| {}, progress);
        Self {
            since: Since::new(campaign, found.rebuilt(campaign.name.clone())),
            found: found.shown,
        }
    }

    /// What has changed since, and the explanation of the new campaign.
    fn changes(
        &self,
        new: &Campaign,
        options: Options<'_>,
        progress: &Progress,
    ) -> (Changes, Found) {
        let experiment = self.since.subtracted_from(new);
        let model = self.since.model.clone();
        let new = Found::with_progress(experiment, model, options, &|_| {}, progress);
        let changes = Changes {
            baseline: self.found.clone(),
            new: new.shown.clone(),
        };
        (changes, new)
    }
}

impl std::fmt::Display for Changes {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (baseline, new) = (&self.baseline, &self.new);
        let line = baseline.as_reference(&sigma(baseline.head.error_after));
        writeln!(f, "{}", wrapped(&line))?;
        let line = format!(
            "New {}: error {} -> {} sigma",
            new.head.campaign,
            sigma(new.head.error_before),
            sigma(new.head.error_after)
        );
        writeln!(f, "{}", wrapped(&line))?;
        if new.steps.is_empty() {
            return writeln!(f, "\n{}", Explanation::UNCHANGED);
        }
        writeln!(f, "\nChanges:")?;
        let mut steps = new.steps.iter().enumerate();
        steps.try_for_each(|(index, step)| write!(f, "  {}. {step}", index + 1))
    }
}
