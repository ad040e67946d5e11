//! What `hitch explain` and `hitch diagnose` found, as scripts read it (JSON) and as people do (text).
mod found;
mod next;
mod of_diagnosis;
mod of_explanation;
mod of_suggestion;
mod rebuilt;
mod show;

pub use found::{Explained, Found};
pub use next::{Detail, Next};
pub use of_diagnosis::explained;
pub use of_explanation::parameters;
pub use rebuilt::rebuilt;
pub use show::late_ms;

use serde::Serialize;
use serde_json::{Map, Value};

/// Result of `hitch explain`.
#[derive(Debug, Clone, Serialize)]
pub struct Explanation {
    /// Head, alike for every result.
    #[serde(flatten)]
    pub head: Head,
    /// Error of the model before with its own effects fitted anew, in sigma; `None` if it has none.
    pub error_refitted: Option<f64>,
    /// The effects added or changed, in order.
    pub steps: Vec<Step>,
    /// What stays unexplained.
    pub unexplained: Unexplained,
    /// What would not have been seen at its typical size, the faintest first; empty if something stays unexplained.
    pub not_visible: Vec<NotVisible>,
    /// Whether the search ended, by its time or its number of rounds, before its set stayed: there may be more than the
    /// steps say.
    pub unfinished: bool,
    /// The experiment that would tell most, if one is needed.
    #[serde(flatten)]
    pub next: Next,
}

/// Result of `hitch diagnose`.
#[derive(Debug, Clone, Serialize)]
pub struct Diagnosis {
    /// Head, alike for every result; the error after is that of the best candidate, if it is believed.
    #[serde(flatten)]
    pub head: Head,
    /// Effects that could be missing, best first.
    pub candidates: Vec<Candidate>,
    /// The experiment that would tell the best two apart, if these data do not.
    #[serde(flatten)]
    pub next: Next,
}

/// What every result on a campaign begins with.
#[derive(Debug, Clone, Serialize)]
pub struct Head {
    /// Name of the campaign.
    pub campaign: String,
    /// Name of the model it began with.
    pub model: String,
    /// Error of that model, in sigma.
    pub error_before: f64,
    /// Error of the model that it came to, in sigma.
    pub error_after: f64,
    /// Error of a perfect model: the instruments' noise, in sigma.
    pub noise_floor: f64,
    /// By channel key, in the channel's unit: the error before and after, the noise of the instrument, and
    /// how late its clock is against that of the currents, s.
    pub channels: Map<String, Value>,
    /// The answer in a word.
    pub verdict: &'static str,
    /// Whether the error is large everywhere, with effects as without: then the base is to be fitted first.
    pub hopeless_base: bool,
}

/// What is said first of a model that is wrong everywhere.
pub const HOPELESS_BASE: &str = "This looks like another machine: the error is large everywhere. Fit the base first: \
    hitch model fit CAMPAIGN --model MODEL --out FILE";

/// One effect that was added.
#[derive(Debug, Clone, Serialize)]
pub struct Step {
    /// Id of the effect.
    pub effect: &'static str,
    /// Which of its equations, if it has several and this is not the usual one.
    pub form: Option<&'static str>,
    /// Whether another of its equations would explain the campaign as well.
    pub form_undetermined: bool,
    /// Those; `null` is the usual one.
    pub other_forms: Vec<Option<&'static str>>,
    /// The size that the model had before, in the unit of the first parameter; `None` if the effect is new.
    pub changed_from: Option<f64>,
    /// Error before it was added, in sigma.
    pub error_before: f64,
    /// Error after it was added, in sigma.
    pub error_after: f64,
    /// Error before, on runs that were not used to fit.
    pub held_out_before: f64,
    /// Error after, on runs that were not used to fit.
    pub held_out_after: f64,
    /// The error before on those runs as a fit counts it, by which effects are chosen: far outliers by their distance.
    pub held_out_loss_before: f64,
    /// The same after.
    pub held_out_loss_after: f64,
    /// How sure the data make one that it is this effect, 0 to 1.
    pub confidence: f64,
    /// Of the mean square that would be left beyond noise without it, where it shows, the share that it explains.
    pub explained_share: f64,
    /// Effects that it cannot be told from on these data.
    pub indistinguishable: Vec<&'static str>,
    /// The same with how far apart they are.
    pub alternatives: Vec<Alternative>,
    /// Root mean square of its signature that nothing else can take on, in sigma.
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

/// An effect's id, with its form if it has one, as commands take it: see [`hitch_plant::full_name`].
fn with_form(id: &str, form: Option<&str>) -> String {
    form.map_or_else(|| id.to_owned(), |form| format!("{id}/{form}"))
}

/// An effect that explains the campaign as well in place of another.
#[derive(Debug, Clone, Serialize)]
pub struct Alternative {
    /// Id of the effect.
    pub effect: &'static str,
    /// Angle between what the two do to this campaign that nothing else could, degree.
    pub angle_deg: f64,
    /// Error with it instead, in sigma.
    pub error_after: f64,
}

/// An effect that this campaign would not show.
#[derive(Debug, Clone, Serialize)]
pub struct NotVisible {
    /// Id of the effect.
    pub effect: &'static str,
    /// Root mean square of its signature at its typical size that nothing else can take on, in sigma.
    pub detectability: f64,
    /// Channels that it shows in and the campaign lacks.
    pub missing_channels: Vec<&'static str>,
    /// What it would show in.
    pub shows: &'static str,
}

/// An effect that could be missing.
#[derive(Debug, Clone, Serialize)]
pub struct Candidate {
    /// Id of the effect.
    pub effect: &'static str,
    /// Which of its equations, if it has several and this is not the usual one.
    pub form: Option<&'static str>,
    /// Share of the squared error above the noise that it would explain, 0 to 1.
    pub explains: f64,
    /// Error with it, in sigma.
    pub error_after: f64,
    /// How sure the data make one that it is this effect, 0 to 1.
    pub confidence: f64,
    /// Effects that it cannot be told from on these data.
    pub indistinguishable: Vec<&'static str>,
    /// Root mean square of its signature that nothing else can take on, in sigma.
    pub detectability: f64,
    /// Its parameters.
    pub parameters: Vec<Parameter>,
}

/// A parameter with its interval.
#[derive(Debug, Clone, Serialize)]
pub struct Parameter {
    /// Name.
    pub name: &'static str,
    /// Unit; empty for a pure number.
    pub unit: &'static str,
    /// Estimate.
    pub value: f64,
    /// Lower end of the 95 % interval.
    pub low: f64,
    /// Upper end of the 95 % interval.
    pub high: f64,
    /// Whether the estimate is at an end of the range that the catalogue allows: it is no measurement then.
    pub at_its_limit: bool,
}

/// What the catalogue does not explain.
#[derive(Debug, Clone, Serialize)]
pub struct Unexplained {
    /// Share of the squared error above the noise that stays, 0 to 1.
    pub share: f64,
    /// Signals that it goes with, best first.
    pub depends_on: Vec<String>,
    /// Where it is largest: range of the first of these signals, end of the travel, motion.
    #[serde(rename = "where")]
    pub whereabouts: Option<String>,
    /// A formula for it, with the place where it acts, if one was found.
    pub suggested_term: Option<String>,
    /// The same with all that belongs to it.
    pub suggested: Option<Suggested>,
}

/// A term that would help: a candidate for a model file, not an identified cause.
#[derive(Debug, Clone, Serialize)]
pub struct Suggested {
    /// Where it acts.
    pub place: &'static str,
    /// Its formula.
    pub formula: String,
    /// Its parameters.
    pub parameters: Vec<Parameter>,
    /// Error without it, on runs that were not used to fit.
    pub held_out_before: f64,
    /// Error with it, on runs that were not used to fit.
    pub held_out_after: f64,
    /// Error with it.
    pub error_after: f64,
    /// Steps that are not needed beside it.
    pub replaces: Vec<&'static str>,
    /// The term as it is written into a model file.
    pub model_file: String,
}
