//! What to measure next, as scripts read it: a sentence, and its parts.

use hitch_identification::design::NextExperiment;
use serde::Serialize;

/// What to measure next, if anything.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Next {
    /// In one sentence.
    pub next_experiment: Option<String>,
    /// In its parts.
    pub next_experiment_detail: Option<Detail>,
}

/// The parts of a proposed experiment.
#[derive(Debug, Clone, Serialize)]
pub struct Detail {
    /// What to do.
    pub manoeuvre: String,
    /// What it is good for.
    pub why: String,
    /// Ids of the pairs of effects that it would tell apart.
    pub separates: Vec<[&'static str; 2]>,
    /// Smallest likelihood ratio to expect for these; of all manoeuvres the largest if none would tell any apart;
    /// `None` if nothing was simulated.
    pub expected_likelihood_ratio: Option<f64>,
    /// Rig time, minutes; `None` if no manoeuvre is proposed.
    pub minutes: Option<f64>,
}

impl From<Option<NextExperiment>> for Next {
    fn from(found: Option<NextExperiment>) -> Self {
        Self {
            next_experiment: found.as_ref().map(ToString::to_string),
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
            manoeuvre: found.manoeuvre,
            why: found.why,
        }
    }
}
