//! What `hitch explain` and `hitch diagnose` found, as scripts read it (JSON) and as people do (text).
mod show;

use serde::Serialize;
use serde_json::{Map, Value};

/// Result of `hitch explain`.
#[derive(Debug, Clone, Serialize)]
pub struct Explanation {
    /// Head, alike for every result on a campaign.
    #[serde(flatten)]
    pub head: Head,
    /// Error of the model with all effects of `steps`, in sigma.
    pub error_after: f64,
    /// Root mean square of the differences by channel key, in the channel's unit: before, after, and the noise.
    pub channels: Map<String, Value>,
    /// The answer in a word.
    pub verdict: String,
    /// The effects added, in order.
    pub steps: Vec<Step>,
    /// What stays unexplained.
    pub unexplained: Unexplained,
    /// The experiment that would tell most, if one is needed.
    pub next_experiment: Option<String>,
}

/// Result of `hitch diagnose`.
#[derive(Debug, Clone, Serialize)]
pub struct Diagnosis {
    /// Head, alike for every result on a campaign.
    #[serde(flatten)]
    pub head: Head,
    /// The answer in a word.
    pub verdict: String,
    /// Effects that could be missing, best first.
    pub candidates: Vec<Candidate>,
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
    /// Error of a perfect model: the instruments' noise, in sigma.
    pub noise_floor: f64,
}

/// One effect that was added.
#[derive(Debug, Clone, Serialize)]
pub struct Step {
    /// Id of the effect.
    pub effect: String,
    /// Error before it was added, in sigma.
    pub error_before: f64,
    /// Error after it was added, in sigma.
    pub error_after: f64,
    /// Error before, on runs that were not used to fit.
    pub held_out_before: f64,
    /// Error after, on runs that were not used to fit.
    pub held_out_after: f64,
    /// How sure the data make one that it is this effect, 0 to 1.
    pub confidence: f64,
    /// Effects that it cannot be told from on these data.
    pub indistinguishable: Vec<String>,
    /// Root mean square of its signature that nothing else can take on, in sigma.
    pub detectability: f64,
    /// Its parameters.
    pub parameters: Vec<Parameter>,
}

/// A parameter with its interval.
#[derive(Debug, Clone, Serialize)]
pub struct Parameter {
    /// Name.
    pub name: String,
    /// Unit.
    pub unit: String,
    /// Estimate.
    pub value: f64,
    /// Lower end of the interval.
    pub low: f64,
    /// Upper end of the interval.
    pub high: f64,
}

/// What the catalogue does not explain.
#[derive(Debug, Clone, Serialize)]
pub struct Unexplained {
    /// Share of the squared error above the noise that stays, 0 to 1.
    pub share: f64,
    /// Signals that it goes with, best first.
    pub depends_on: Vec<String>,
    /// A formula for it, if one was found.
    pub suggested_term: Option<String>,
}

/// An effect that could be missing.
#[derive(Debug, Clone, Serialize)]
pub struct Candidate {
    /// Id of the effect.
    pub effect: String,
    /// Share of the squared error above the noise that it would explain, 0 to 1.
    pub explains: f64,
    /// Error with it, in sigma.
    pub error_after: f64,
    /// How sure the data make one that it is this effect, 0 to 1.
    pub confidence: f64,
    /// Effects that it cannot be told from on these data.
    pub indistinguishable: Vec<String>,
    /// Root mean square of its signature that nothing else can take on, in sigma.
    pub detectability: f64,
    /// Its parameters.
    pub parameters: Vec<Parameter>,
}
