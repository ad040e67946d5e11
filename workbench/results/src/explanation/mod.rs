//! Results of `hitch explain` and `hitch diagnose`, as JSON and as text.
mod base;
mod channel_figures;
mod corrected;
mod found;
mod next;
mod of_diagnosis;
mod of_explanation;
mod of_suggestion;
mod planned;
mod rebuilt;
mod show;
mod since;

pub use base::{Base, Posed};
pub use channel_figures::ChannelFigures;
pub use corrected::Corrected;
pub use found::{Explained, Found};
pub use next::{Detail, Next, TWO_LINES};
pub use of_diagnosis::explained;
pub use of_explanation::parameters;
pub use planned::{PlannedRun, files as planned_files, planned};
pub use rebuilt::{rebuilt, saving};
pub use show::meanings;
pub use since::Since;

use indexmap::IndexMap;
use schemars::JsonSchema;
use serde::Serialize;

/// Result of `hitch explain`.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Explanation {
    /// Head, common to all results.
    #[serde(flatten)]
    pub head: Head,
    /// Error of the model with its own effects refitted, in sigma; `None` if it has none.
    pub error_refitted: Option<f64>,
    /// The constants of the base model, if the declared ones are off; `null` if they are not.
    pub corrected_constants: Option<Corrected>,
    /// The effects added or changed, in order.
    pub steps: Vec<Step>,
    /// Effects that reduce the error and are not named, because their probability is below one half; `error_after` is the error
    /// with them.
    pub doubtful: Vec<Step>,
    /// The remaining error.
    pub unexplained: Unexplained,
    /// Effects that are not detectable at their typical size, in ascending order of detectability; empty if an error
    /// remains.
    pub not_visible: Vec<NotVisible>,
    /// Whether the search stopped, at its time or round limit, before its result was stable: there may be more effects
    /// than steps.
    pub unfinished: bool,
    /// The most informative next experiment, if one is needed.
    #[serde(flatten)]
    pub next: Next,
}

/// Result of `hitch diagnose`.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Diagnosis {
    /// Head, common to all results; the error after is that of the best candidate, if it is accepted.
    #[serde(flatten)]
    pub head: Head,
    /// Effects that may be missing, best first.
    pub candidates: Vec<Candidate>,
    /// Probability that the declared constants are off, given the best candidate, 0 to 1.
    pub constants_off: f64,
    /// The experiment that separates the best two candidates, if these data do not.
    #[serde(flatten)]
    pub next: Next,
}

/// Head of every result on a campaign.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Head {
    /// Name of the campaign.
    pub campaign: String,
    /// Name of the initial model.
    pub model: String,
    /// Error of the initial model, in sigma.
    pub error_before: f64,
    /// Error of the final model, in sigma.
    pub error_after: f64,
    /// Error of a perfect model: the noise of the instruments, in sigma.
    pub noise_floor: f64,
    /// By channel key: errors, noise and delay.
    pub channels: IndexMap<&'static str, ChannelFigures>,
    /// Verdict: `nothing-missing`, `explained`, `ambiguous`, `unexplained` or `not-enough-data`.
    pub verdict: &'static str,
    /// Whether the base is unsuitable: the error is large everywhere, with and without effects.
    pub unsuitable_base: bool,
}

/// First message on an unsuitable base.
pub const UNSUITABLE_BASE: &str = "The base model does not match this machine: the error is large everywhere. Fit the base first: \
    hitch model fit CAMPAIGN --model MODEL --out FILE";

/// One added effect.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Step {
    /// Id of the effect.
    pub effect: &'static str,
    /// Its form, unless it is the default form.
    pub form: Option<&'static str>,
    /// Whether another form explains the campaign equally well.
    pub form_undetermined: bool,
    /// Those forms; `null` is the default form.
    pub other_forms: Vec<Option<&'static str>>,
    /// Its size in the initial model, in the unit of the first parameter; `None` if the effect is new.
    pub changed_from: Option<f64>,
    /// Error before it was added, in sigma.
    pub error_before: f64,
    /// Error after it was added, in sigma.
    pub error_after: f64,
    /// Error before, on held-out runs, in sigma; `null` if no run was held out.
    #[schemars(with = "Option<f64>")]
    pub held_out_before: f64,
    /// Error after, on held-out runs, in sigma; `null` if no run was held out.
    #[schemars(with = "Option<f64>")]
    pub held_out_after: f64,
    /// Error before on held-out runs with the robust loss of the fit, in sigma, the criterion for choosing effects;
    /// `null` if no run was held out.
    #[schemars(with = "Option<f64>")]
    pub held_out_loss_before: f64,
    /// The same after; `null` if no run was held out.
    #[schemars(with = "Option<f64>")]
    pub held_out_loss_after: f64,
    /// Confidence that it is this effect, 0 to 1.
    pub confidence: f64,
    /// Share of the mean square beyond noise that it explains, 0 to 1, relative to the model without it, where it acts.
    pub explained_share: f64,
    /// Effects that are indistinguishable from it on these data.
    pub indistinguishable: Vec<&'static str>,
    /// The same with the angles between their signatures.
    pub alternatives: Vec<Alternative>,
    /// Root mean square of its signature, all other effects projected out, in sigma.
    pub detectability: f64,
    /// Its parameters.
    pub parameters: Vec<Parameter>,
}

impl Step {
    /// The effect with its form.
    #[must_use]
    pub fn name(&self) -> String {
        with_form(self.effect, self.form)
    }
}

impl Candidate {
    /// The effect with its form.
    #[must_use]
    pub fn name(&self) -> String {
        with_form(self.effect, self.form)
    }
}

/// Id of an effect, with its form if any, as commands accept it: see [`hitch_plant::full_name`].
fn with_form(id: &str, form: Option<&str>) -> String {
    form.map_or_else(|| id.to_owned(), |form| format!("{id}/{form}"))
}

/// An effect that explains the campaign equally well in place of another.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Alternative {
    /// Id of the effect.
    pub effect: &'static str,
    /// Angle between the two signatures, all other effects projected out, degree.
    #[schemars(with = "Option<f64>")]
    pub angle_deg: f64,
    /// Error with it instead, in sigma.
    pub error_after: f64,
}

/// An effect that is not detectable in this campaign.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct NotVisible {
    /// Id of the effect.
    pub effect: &'static str,
    /// Root mean square of its signature at its typical size, all other effects projected out, in sigma.
    pub detectability: f64,
    /// Channels in which it acts and that the campaign lacks.
    pub missing_channels: Vec<&'static str>,
    /// Conditions in which it is visible.
    pub shows: &'static str,
}

/// An effect that may be missing.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Candidate {
    /// Id of the effect.
    pub effect: &'static str,
    /// Its form, unless it is the default form.
    pub form: Option<&'static str>,
    /// Share of the squared error above the noise that it explains, 0 to 1.
    pub explains: f64,
    /// Error with it, in sigma.
    pub error_after: f64,
    /// Confidence that it is this effect, 0 to 1.
    pub confidence: f64,
    /// Effects that are indistinguishable from it on these data.
    pub indistinguishable: Vec<&'static str>,
    /// Root mean square of its signature, all other effects projected out, in sigma.
    pub detectability: f64,
    /// Its parameters.
    pub parameters: Vec<Parameter>,
}

/// A parameter with its interval.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Parameter {
    /// Name.
    pub name: &'static str,
    /// What it is, in a few words.
    pub meaning: &'static str,
    /// Unit; empty for a pure number.
    pub unit: &'static str,
    /// Estimate, in the unit.
    pub value: f64,
    /// Lower end of the 95 % interval, in the unit; `null` if it is unknown.
    #[schemars(with = "Option<f64>")]
    pub low: f64,
    /// Upper end of the 95 % interval, in the unit; `null` if it is unknown.
    #[schemars(with = "Option<f64>")]
    pub high: f64,
    /// Whether the estimate is at an end of its allowed range and therefore not a measurement.
    pub at_its_limit: bool,
}

/// The error that the catalogue does not explain.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Unexplained {
    /// Remaining share of the squared error above the noise, 0 to 1.
    pub share: f64,
    /// Signals that it correlates with, best first.
    pub depends_on: Vec<String>,
    /// Where it is largest: range of the first signal, end of travel, direction of motion.
    #[serde(rename = "where")]
    pub whereabouts: Option<String>,
    /// A formula for it and the place where it acts, if found.
    pub suggested_term: Option<String>,
    /// The suggested term in full.
    pub suggested: Option<Suggested>,
}

/// A suggested term: a candidate for a model file, not an identified cause.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Suggested {
    /// Where it acts.
    pub place: &'static str,
    /// Its formula.
    pub formula: String,
    /// Its parameters.
    pub parameters: Vec<Parameter>,
    /// Error without it, on held-out runs, in sigma; `null` if no run was held out.
    #[schemars(with = "Option<f64>")]
    pub held_out_before: f64,
    /// Error with it, on held-out runs, in sigma; `null` if no run was held out.
    #[schemars(with = "Option<f64>")]
    pub held_out_after: f64,
    /// Error with it, in sigma.
    pub error_after: f64,
    /// Steps that are redundant beside it.
    pub replaces: Vec<&'static str>,
    /// The term as it is written into a model file.
    pub model_file: String,
}
