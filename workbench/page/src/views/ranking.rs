//! A ranking of the effects that the present model may lack.

use schemars::JsonSchema;
use serde::Serialize;

use super::candidate::ShownCandidate;
use super::effect_texts::EffectTexts;
use super::next_experiment::ProposedExperiment;
use crate::session::Ranking;
use hitch_output::text::words;
use hitch_results::explanation::Candidate;

/// A ranking of the effects that the present model may lack.
#[derive(Debug, Serialize, JsonSchema)]
pub struct ShownRanking {
    /// Error of the present model, sigma.
    pub error_before: f64,
    /// The candidates, best first.
    pub candidates: Vec<ShownCandidate>,
    /// The experiment that separates the best ones.
    pub next: Option<ProposedExperiment>,
    /// A hint that the declared constants may be off.
    pub constants_hint: Option<String>,
}

impl ShownRanking {
    /// A finished ranking.
    pub fn of(ranking: &Ranking) -> Self {
        let shown = &ranking.shown;
        let candidate = |shown: &Candidate| {
            let found = ranking.candidate(&shown.name())?;
            Some(ShownCandidate {
                effect: EffectTexts::of(found.effect),
                explains: shown.explains,
                error_after: shown.error_after,
                confidence: Some(shown.confidence),
                in_words: Some(words::in_words(shown.confidence)),
                indistinguishable: Some(shown.indistinguishable.clone()),
                parameters: shown.parameters.clone(),
            })
        };
        Self {
            error_before: shown.head.error_before,
            candidates: shown.candidates.iter().filter_map(candidate).collect(),
            next: ProposedExperiment::of(&shown.next),
            constants_hint: shown.constants_hint(),
        }
    }
}
