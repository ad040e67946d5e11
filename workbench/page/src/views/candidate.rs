//! A candidate of a ranking.

use hitch_identification::estimation::fit::Fit;
use hitch_identification::selection::candidate::Candidate;
use schemars::JsonSchema;
use serde::Serialize;

use super::effect_texts::EffectTexts;
use hitch_results::explanation::{Parameter, explained, parameters};

/// An effect that may be missing. Its confidence is known only when all are evaluated.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ShownCandidate {
    /// Its texts.
    pub effect: EffectTexts,
    /// Share of the squared error above the noise that it explains, 0 to 1.
    pub explains: f64,
    /// Error with it, sigma.
    pub error_after: f64,
    /// Confidence that it is this effect, 0 to 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub confidence: Option<f64>,
    /// The confidence in words.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub in_words: Option<&'static str>,
    /// Effects that are indistinguishable from it on these data.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub indistinguishable: Option<Vec<&'static str>>,
    /// Its parameters.
    pub parameters: Vec<Parameter>,
}

impl ShownCandidate {
    /// A candidate directly after its evaluation.
    pub fn tried(base: &Fit, candidate: &Candidate) -> Self {
        Self {
            effect: EffectTexts::of(candidate.effect),
            explains: explained(base, &candidate.fit),
            error_after: candidate.fit.error(),
            confidence: None,
            in_words: None,
            indistinguishable: None,
            parameters: parameters(candidate.effect, candidate.values(), &candidate.intervals),
        }
    }
}
