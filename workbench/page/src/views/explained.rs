//! The explanation of a campaign.

use hitch_identification::explanation::explain::ExplanationStep;
use schemars::JsonSchema;
use serde::Serialize;

use super::effect_texts::EffectTexts;
use super::next_experiment::ProposedExperiment;
use crate::session::Explained;
use hitch_output::text::words;
use hitch_results::base_model::fit::ShownConstant;
use hitch_results::explanation::{Corrected, Parameter, Step, Suggested};

/// An explanation that starts from the present model; errors in sigma.
#[derive(Debug, Serialize, JsonSchema)]
pub struct ShownExplanation {
    /// Error of the model that it starts from: the present one, with constants in the middle of their ranges.
    pub error_before: f64,
    /// Error with all steps.
    pub error_after: f64,
    /// Verdict.
    pub verdict: &'static str,
    /// What the verdict means.
    pub meaning: &'static str,
    /// Corrected constants of the base model.
    pub constants: Option<CorrectedConstants>,
    /// The effects added or changed, in order.
    pub steps: Vec<ExplainedStep>,
    /// Whether the search ended, at its limit or cancelled, before its result was stable.
    pub unfinished: bool,
    /// Why effects that reduce the error are not named, a sentence each.
    pub doubtful: Vec<String>,
    /// A term for the remaining error.
    pub suggested: Option<Suggested>,
    /// Ids of effects that are not detectable in the campaign.
    pub not_visible: Vec<&'static str>,
    /// The most informative next experiment, if one is needed.
    pub next: Option<ProposedExperiment>,
}

/// A step of an explanation; errors in sigma.
#[derive(Debug, Serialize, JsonSchema)]
pub struct ExplainedStep {
    /// Texts of its effect.
    pub effect: EffectTexts,
    /// Its size in the present model, in the unit of the first parameter; `null` if the effect is new.
    pub changed_from: Option<f64>,
    /// Error before it.
    pub error_before: f64,
    /// Error with it.
    pub error_after: f64,
    /// Error with it on held-out runs; `null` if no run was held out.
    #[schemars(with = "Option<f64>")]
    pub held_out_after: f64,
    /// Confidence that it is this effect, 0 to 1.
    pub confidence: f64,
    /// The confidence in words.
    pub in_words: &'static str,
    /// Effects that are indistinguishable from it on these data.
    pub indistinguishable: Vec<&'static str>,
    /// Its parameters.
    pub parameters: Vec<Parameter>,
}

/// Corrected constants of the base model.
#[derive(Debug, Serialize, JsonSchema)]
pub struct CorrectedConstants {
    /// What they bring.
    pub sentence: String,
    /// Why there are no intervals; `null` if there are.
    pub withheld: Option<String>,
    /// Those that differ from the declared ones.
    pub moved: Vec<ShownConstant>,
    /// Changes of the flow curves.
    pub curves: Vec<CurveChange>,
}

/// Change of a flow curve, as shares of the declared flow.
#[derive(Debug, Serialize, JsonSchema)]
pub struct CurveChange {
    /// Table of the valve.
    pub valve: &'static str,
    /// Smallest change.
    pub low: f64,
    /// Largest change.
    pub high: f64,
}

impl ShownExplanation {
    /// A finished explanation.
    pub fn of(explained: &Explained) -> Self {
        let shown = &explained.found.shown;
        let steps = explained.found.explanation.steps.iter().zip(&shown.steps);
        let constants = shown.corrected_constants.as_ref();
        Self {
            error_before: shown.head.error_before,
            error_after: shown.head.error_after,
            verdict: shown.head.verdict,
            meaning: shown.meaning(),
            constants: constants
                .map(|corrected| CorrectedConstants::of(corrected, shown.head.error_before)),
            steps: steps
                .map(|(found, shown)| ExplainedStep::of(found, shown))
                .collect(),
            unfinished: shown.unfinished,
            doubtful: shown.doubtful.iter().map(Step::doubt).collect(),
            suggested: shown.unexplained.suggested.clone(),
            not_visible: shown
                .not_visible
                .iter()
                .map(|effect| effect.effect)
                .collect(),
            next: ProposedExperiment::of(&shown.next),
        }
    }
}

impl ExplainedStep {
    fn of(found: &ExplanationStep, shown: &Step) -> Self {
        Self {
            effect: EffectTexts::of(found.effect),
            changed_from: shown.changed_from,
            error_before: shown.error_before,
            error_after: shown.error_after,
            held_out_after: shown.held_out_after,
            confidence: shown.confidence,
            in_words: words::in_words(shown.confidence),
            indistinguishable: shown.indistinguishable.clone(),
            parameters: shown.parameters.clone(),
        }
    }
}

impl CorrectedConstants {
    fn of(corrected: &Corrected, error_before: f64) -> Self {
        let curves = corrected.flow_changes().into_iter();
        Self {
            sentence: corrected.sentence(error_before),
            withheld: corrected.withheld.clone(),
            moved: corrected.moved().cloned().collect(),
            curves: curves
                .map(|(valve, low, high)| CurveChange { valve, low, high })
                .collect(),
        }
    }
}
