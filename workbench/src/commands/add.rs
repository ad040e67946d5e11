//! `hitch add`: adds effects to a model and estimates their parameters.

use std::fmt::Write as _;
use std::path::PathBuf;

use hitch_identification::adequacy::unsuitable_base::is_unsuitable;
use hitch_identification::data::experiment::Experiment;
use hitch_identification::data::problem::Problem;
use hitch_identification::estimation::fit::{Fit, refine};
use hitch_identification::explanation::explain::fit_base;
use hitch_identification::search::single_effects::try_effects;
use hitch_identification::selection::evidence::SIGNIFICANT;
use hitch_identification::selection::leave_one_out::{LeaveOneOut, leave_one_out};
use hitch_plant::{Effect, Model, full_name};

use hitch_output::error::Error;
use hitch_output::progress::Progress;
use hitch_output::targets::{Outputs, campaign_files};
use hitch_output::text::{indented, joined, wrapped};
use hitch_results::arguments::baseline::BaselineArg;
use hitch_results::arguments::effect::find;
use hitch_results::arguments::model::ModelArg;
use hitch_results::explanation::{Base, Posed, UNSUITABLE_BASE, parameters, rebuilt};

/// Arguments of `hitch add`.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Example: hitch add lower-threshold-shift --campaign lab-a --out lab-a.toml"
)]
pub struct Args {
    /// Effects to add, in this order; `hitch effects` lists them
    #[arg(required = true, value_name = "EFFECT")]
    effects: Vec<String>,
    /// Folder of the campaign for the estimation of their parameters
    #[arg(long, value_name = "CAMPAIGN")]
    campaign: PathBuf,
    #[command(flatten)]
    model: ModelArg,
    #[command(flatten)]
    baseline: BaselineArg,
    /// Write the model to this file
    #[arg(long, value_name = "MODEL.toml")]
    out: PathBuf,
}

/// Runs the command.
///
/// # Errors
/// If an effect is unknown or present already, an input is invalid, or the model cannot be written.
pub fn run(args: &Args) -> Result<(), Error> {
    let mut inputs = campaign_files(&args.campaign);
    inputs.push(args.model.file());
    inputs.extend(args.baseline.files());
    let outputs = Outputs::check([Some(args.out.as_path())], &inputs)?;
    let start = Base::load(&args.model, &args.baseline)?;
    let effects = effects(&args.effects, start.model())?;
    let Posed {
        model,
        campaign,
        experiment,
    } = start.posed(&args.campaign)?;
    let progress = Progress::start(format!("fitting {} to {}", model.name, campaign.name));
    let base = fit_base(Problem::new(&experiment, &model));
    let fit = fit_with(&experiment, &model, base.clone(), &effects, &progress);
    progress.say("evaluating each effect with the others present");
    let weighed = leave_one_out(Problem::new(&experiment, &model), &fit, model.effects.len());
    drop(progress);
    let rebuilt = rebuilt(&model, &fit.estimate, hitch_output::stem(&args.out));
    hitch_output::write_file(&args.out, hitch_model_file::to_toml(&rebuilt).as_bytes())?;
    let mut text = if is_unsuitable(&experiment, &base, &fit) {
        format!("{}\n\n", wrapped(UNSUITABLE_BASE))
    } else {
        String::new()
    };
    // Writing to a string cannot fail.
    let head = format!(
        "Campaign {}, model {}: error {:.2} sigma",
        campaign.name,
        model.name,
        base.error()
    );
    let _ = writeln!(text, "{}", wrapped(&head));
    for effect in &weighed {
        let _ = writeln!(text, "{}", indented(&shown(effect), 2));
    }
    let _ = writeln!(text, "With all effects: error {:.2} sigma", fit.error());
    outputs.say(|| text)
}

/// The model with the effects, fitted jointly.
fn fit_with(
    experiment: &Experiment,
    model: &Model,
    base: Fit,
    effects: &[&'static dyn Effect],
    progress: &Progress,
) -> Fit {
    let say = |what: &str| progress.say(format!("fitting {what}"));
    let mut fit = base;
    for effect in effects {
        let tried = try_effects(Problem::new(experiment, model), &fit, &[*effect], &say);
        if let Some(candidate) = tried.into_iter().next() {
            fit = candidate.fit;
        }
    }
    // Insignificant effects are fitted only coarsely in the trial.
    refine(Problem::new(experiment, model), fit.estimate)
}

/// The effects of these names; none of them may be in the model.
fn effects(ids: &[String], model: &Model) -> Result<Vec<&'static dyn Effect>, Error> {
    let mut effects: Vec<&'static dyn Effect> = Vec::new();
    for id in ids {
        let effect = find(model, id)?;
        let present = model
            .effects
            .iter()
            .map(|added| added.effect)
            .chain(effects.iter().copied());
        if present
            .into_iter()
            .any(|present| present.id() == effect.id())
        {
            return Err(Error::Usage(format!(
                "effect {id} is in the model already; omit it"
            )));
        }
        effects.push(effect);
    }
    Ok(effects)
}

fn shown(effect: &LeaveOneOut) -> String {
    let candidate = &effect.candidate;
    let parameters = parameters(candidate.effect, candidate.values(), &candidate.intervals);
    let line = format!(
        "+ {}: {}; error {:.2} sigma without it",
        full_name(candidate.effect),
        joined(parameters, ", "),
        effect.without.error()
    );
    if candidate.likelihood_ratio < SIGNIFICANT {
        return line + " (no significant improvement)";
    }
    line
}
