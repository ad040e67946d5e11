//! The command that continues the work after a result.

use std::path::Path;

use crate::arguments::baseline::BaselineArg;
use crate::arguments::model::ModelArg;
use hitch_output::text::{shell_word, wrapped};

/// File names of the proposed commands.
const MODEL: &str = "better.toml";
const REPORT: &str = "better.html";
const CALIBRATION: &str = "calibration.toml";

/// What a campaign shows of a model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Standing {
    /// The error is noise.
    Adequate,
    /// Effects are missing.
    Inadequate,
    /// The constants are those of another machine.
    UnsuitableBase,
}

/// After `hitch compare` and `hitch diagnose`: the valve map of an adequate model, the missing effects of an inadequate one,
/// or the fit of its base.
#[must_use]
pub fn next(
    standing: Standing,
    campaign: &Path,
    model: &ModelArg,
    baseline: &BaselineArg,
) -> String {
    match standing {
        Standing::Adequate => calibrate(&model.word()),
        Standing::Inadequate => line(
            "find the missing effects",
            &format!(
                "{} --out {MODEL} --report {REPORT}",
                explain(campaign, model, baseline)
            ),
        ),
        Standing::UnsuitableBase => {
            let fit = format!(
                "hitch model fit {}{}",
                shell_word(campaign),
                model.written()
            );
            line("fit the base model", &format!("{fit} --out {MODEL}"))
        }
    }
}

/// After `hitch explain`: the valve map of the written model; without one, the command that writes it.
#[must_use]
pub fn after_explanation(
    written: Option<&Path>,
    campaign: &Path,
    model: &ModelArg,
    baseline: &BaselineArg,
) -> String {
    match written {
        Some(file) => calibrate(&shell_word(file)),
        None => line(
            "save the model",
            &format!("{} --out {MODEL}", explain(campaign, model, baseline)),
        ),
    }
}

fn explain(campaign: &Path, model: &ModelArg, baseline: &BaselineArg) -> String {
    let (campaign, model) = (shell_word(campaign), model.written());
    format!("hitch explain {campaign}{model}{}", baseline.written())
}

fn calibrate(model: &str) -> String {
    line(
        "convert the model into the firmware's valve map",
        &format!("hitch calibrate {model} --out {CALIBRATION}"),
    )
}

/// The command stands in a line of its own, so that it can be copied.
fn line(purpose: &str, command: &str) -> String {
    format!("{}\n  {command}\n", wrapped(&format!("Next, {purpose}:")))
}
