//! The project's own identification.

use hitch_campaign::Campaign;
use hitch_effects::find;
use hitch_identification::data::experiment::Experiment;
use hitch_identification::data::problem::Problem;
use hitch_identification::explanation::explain::{Verdict, explain};
use hitch_plant::{Effect, Model};
use hitch_results::explanation::Since;

use super::answer::Answer;

/// Its answer on a campaign, with the initial model.
#[must_use]
pub fn answer(campaign: &Campaign, model: &Model) -> Answer {
    answer_of(&Experiment::new(campaign, model), model)
}

/// Its answer on a campaign of a machine whose model was adopted from a baseline.
#[must_use]
pub fn answer_since(baseline: &Campaign, campaign: &Campaign, model: &Model) -> Answer {
    let since = Since::new(baseline, model.clone());
    answer_of(&since.subtracted_from(campaign), model)
}

fn answer_of(experiment: &Experiment, model: &Model) -> Answer {
    let explanation = explain(Problem::new(experiment, model), &|_| {});
    let steps = &explanation.steps;
    let id = |effect: &dyn Effect| effect.id().to_owned();
    Answer {
        named: steps.iter().map(|step| id(step.effect)).collect(),
        group: steps
            .iter()
            .flat_map(|step| step.indistinguishable.iter().map(|other| id(other.effect)))
            .collect(),
        unknown: explanation.verdict == Verdict::Unexplained,
        intervals: steps
            .iter()
            .filter_map(|step| {
                let (low, high) = *step.intervals.get(size(step.effect)?)?;
                Some((id(step.effect), low, high))
            })
            .collect(),
        confidences: steps
            .iter()
            .map(|step| (id(step.effect), step.confidence))
            .collect(),
        // A model without effects has the same error on other runs as before.
        held_out: steps.first().zip(steps.last()).map_or_else(
            || (explanation.before.error(), explanation.before.error()),
            |(first, last)| (first.held_out_before.error, last.held_out_after.error),
        ),
        error: explanation.after.error(),
        model: explanation.after.estimate.applied_to(model),
    }
}

/// Index of the parameter with the meaning of the size in the effect's default form.
fn size(effect: &dyn Effect) -> Option<usize> {
    let usual = find(effect.id())?.parameters().first()?;
    let mut parameters = effect.parameters().iter();
    parameters
        .clone()
        .position(|parameter| parameter.name == usual.name)
        .or_else(|| parameters.position(|parameter| parameter.unit == usual.unit))
}
