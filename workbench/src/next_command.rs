//! The command that continues the work after a result.

use std::path::Path;

use crate::model_arg::ModelArg;
use crate::text::wrapped;

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
pub fn next(standing: Standing, campaign: &Path, model: &ModelArg) -> String {
    match standing {
        Standing::Adequate => calibrate(model.name()),
        Standing::Inadequate => explain(campaign, model),
        Standing::UnsuitableBase => {
            let fit = format!("hitch model fit {}{}", path(campaign), model.written());
            line("fit the base model", &format!("{fit} --out {MODEL}"))
        }
    }
}

/// After `hitch explain`: the valve map of the written model; without one, the command that writes it.
#[must_use]
pub fn after_explanation(written: Option<&Path>, campaign: &Path, model: &ModelArg) -> String {
    match written {
        Some(file) => calibrate(&path(file)),
        None => {
            let again = format!("hitch explain {}{}", path(campaign), model.written());
            line("save the model", &format!("{again} --out {MODEL}"))
        }
    }
}

fn explain(campaign: &Path, model: &ModelArg) -> String {
    let command = format!("hitch explain {}{}", path(campaign), model.written());
    line(
        "find the missing effects",
        &format!("{command} --out {MODEL} --report {REPORT}"),
    )
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

/// A path as one word of a shell.
fn path(path: &Path) -> String {
    let text = path.to_string_lossy();
    shlex::try_quote(&text).map_or_else(|_| text.to_string(), |quoted| quoted.into_owned())
}
