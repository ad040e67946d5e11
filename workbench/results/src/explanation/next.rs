//! The proposed next experiment: as a sentence, and in parts.

use hitch_identification::design::{NextExperiment, Proposal};
use schemars::JsonSchema;
use serde::Serialize;

use super::planned::{PlannedRun, planned};

/// What the lines of two models decide.
pub const TWO_LINES: &str =
    "Where the two lines differ by more than the noise, the log decides between them.";

/// The proposed next experiment, if any.
#[derive(Debug, Clone, Default, Serialize, JsonSchema)]
pub struct Next {
    /// As one sentence.
    pub next_experiment: Option<String>,
    /// In parts.
    pub next_experiment_detail: Option<Detail>,
    /// In full, for pictures and files.
    #[serde(skip)]
    pub proposal: Option<Proposal>,
}

/// The parts of a proposed experiment.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Detail {
    /// The manoeuvre.
    pub manoeuvre: String,
    /// Its purpose.
    pub why: String,
    /// Pairs of effect ids that it separates.
    pub separates: Vec<[&'static str; 2]>,
    /// Smallest expected likelihood ratio of these pairs; the largest of all manoeuvres if none separates any; `None`
    /// if nothing was simulated.
    pub expected_likelihood_ratio: Option<f64>,
    /// Rig time, minutes; `None` if no manoeuvre is proposed.
    pub minutes: Option<f64>,
    /// The runs to log; empty if no listed manoeuvre is proposed.
    pub runs: Vec<PlannedRun>,
}

impl From<Option<NextExperiment>> for Next {
    fn from(found: Option<NextExperiment>) -> Self {
        Self {
            next_experiment: found.as_ref().map(ToString::to_string),
            proposal: found.as_ref().and_then(|next| next.proposal.clone()),
            next_experiment_detail: found.map(Detail::from),
        }
    }
}

impl From<NextExperiment> for Detail {
    fn from(found: NextExperiment) -> Self {
        let known = |value: f64| Some(value).filter(|value| value.is_finite());
        let pairs = found.separates.iter();
        Self {
            separates: pairs.map(|(a, b)| [a.id(), b.id()]).collect(),
            expected_likelihood_ratio: known(found.expected_likelihood_ratio),
            minutes: known(found.minutes),
            runs: found.proposal.as_ref().map(planned).unwrap_or_default(),
            manoeuvre: found.manoeuvre,
            why: found.why,
        }
    }
}
