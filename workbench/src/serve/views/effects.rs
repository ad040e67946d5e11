//! JSON views of effects: catalogue, ranking, explanation.

use hitch_identification::estimation::fit::Fit;
use hitch_identification::explanation::explain;
use hitch_identification::selection::candidate;
use hitch_plant::{Effect, Parameter, full_name};
use serde_json::{Value, json};

use crate::explanation::{Candidate, Corrected, Step, explained as share_explained, parameters};
use crate::serve::session::{Explained, Ranking, Session};
use crate::text::words;

/// Texts of an effect.
pub fn described(effect: &dyn Effect) -> Value {
    json!({
        "name": full_name(effect),
        "id": effect.id(),
        "title": effect.title(),
        "equation": effect.equation(),
        "shows": effect.shows(),
        "source": effect.source(),
        "parameters": effect.parameters().iter().map(meaning).collect::<Vec<_>>(),
    })
}

fn meaning(parameter: &Parameter) -> Value {
    json!({ "name": parameter.name, "meaning": parameter.meaning })
}

/// A candidate directly after its evaluation; its confidence is known only when all are evaluated.
pub fn tried(base: &Fit, candidate: &candidate::Candidate) -> Value {
    let values = parameters(candidate.effect, candidate.values(), &candidate.intervals);
    json!({
        "effect": described(candidate.effect),
        "explains": share_explained(base, &candidate.fit),
        "error_after": candidate.fit.error(),
        "parameters": values,
    })
}

/// The ranking, if it belongs to the present model.
pub fn ranking(session: &Session) -> Value {
    let ranking = session.present_ranking();
    ranking.map_or(Value::Null, |ranking| ranked(ranking))
}

fn ranked(ranking: &Ranking) -> Value {
    let shown = &ranking.shown;
    let candidate = |shown: &Candidate| {
        let mut tried = ranking.diagnosis.candidates.iter();
        let tried = tried
            .find(|tried| tried.effect.id() == shown.effect && tried.effect.form() == shown.form)?;
        Some(json!({
            "effect": described(tried.effect),
            "explains": shown.explains,
            "error_after": shown.error_after,
            "confidence": shown.confidence,
            "in_words": words::in_words(shown.confidence),
            "indistinguishable": shown.indistinguishable,
            "parameters": shown.parameters,
        }))
    };
    json!({
        "error_before": shown.head.error_before,
        "candidates": shown.candidates.iter().filter_map(candidate).collect::<Vec<_>>(),
        "next_experiment": shown.next.next_experiment,
        "constants_hint": shown.constants_hint(),
    })
}

/// The explanation, if it starts from the present model.
pub fn explained(session: &Session) -> Value {
    let explained = session.present_explanation();
    explained.map_or(Value::Null, |explained| found(explained))
}

fn found(explained: &Explained) -> Value {
    let shown = &explained.shown;
    let steps = explained.explanation.steps.iter().zip(&shown.steps);
    let step = |(found, shown): (&explain::ExplanationStep, &Step)| {
        json!({
            "effect": described(found.effect),
            "changed_from": shown.changed_from,
            "error_before": shown.error_before,
            "error_after": shown.error_after,
            "held_out_after": shown.held_out_after,
            "confidence": shown.confidence,
            "in_words": words::in_words(shown.confidence),
            "indistinguishable": shown.indistinguishable,
            "parameters": shown.parameters,
        })
    };
    json!({
        "error_before": shown.head.error_before,
        "error_after": shown.head.error_after,
        "verdict": shown.head.verdict,
        "meaning": shown.meaning(),
        "constants": shown.corrected_constants.as_ref().map(|corrected| constants(corrected, shown.head.error_before)),
        "steps": steps.map(step).collect::<Vec<_>>(),
        "unfinished": shown.unfinished,
        "doubtful": shown.doubtful.iter().map(Step::doubt).collect::<Vec<_>>(),
        "suggested": shown.unexplained.suggested,
        "not_visible": shown.not_visible.iter().map(|effect| effect.effect).collect::<Vec<_>>(),
        "next_experiment": shown.next.next_experiment,
    })
}

/// Constants that an explanation corrected.
fn constants(corrected: &Corrected, error_before: f64) -> Value {
    let curves = corrected.flow_changes().into_iter();
    let curve = |(valve, low, high): (&'static str, f64, f64)| json!({ "valve": valve, "low": low, "high": high });
    json!({
        "sentence": corrected.sentence(error_before),
        "withheld": corrected.withheld,
        "moved": corrected.moved().collect::<Vec<_>>(),
        "curves": curves.map(curve).collect::<Vec<_>>(),
    })
}
