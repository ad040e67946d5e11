//! The project's own identification.

use hitch_campaign::Campaign;
use hitch_effects::find;
use hitch_identification::data::experiment::Experiment;
use hitch_identification::data::problem::Problem;
use hitch_identification::explanation::explain::{Verdict, explain_with};
use hitch_identification::search::options::Options;
use hitch_plant::{Effect, Model};
use hitch_workbench::explanation::Since;

use super::answer::{Abilities, Answer, Method};

/// Method of `hitch explain`.
#[derive(Debug)]
pub struct Explaining;

impl Method for Explaining {
    fn name(&self) -> &'static str {
        "hitch explain"
    }

    fn abilities(&self) -> Abilities {
        Abilities {
            names: true,
            unknown: true,
            intervals: true,
        }
    }

    fn answer(&self, campaign: &Campaign, model: &Model) -> Answer {
        let experiment = Experiment::new(campaign, model);
        answer(&experiment, model, Options::default())
    }

    fn answer_since(&self, baseline: &Campaign, campaign: &Campaign, model: &Model) -> Answer {
        let since = Since::new(baseline, model.clone());
        answer(&since.subtracted_from(campaign), model, Options::default())
    }
}

fn answer(experiment: &Experiment, model: &Model, options: Options<'_>) -> Answer {
    let explanation = explain_with(Problem::new(experiment, model), options, &|_| {});
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
        held_out: Some(steps.first().zip(steps.last()).map_or_else(
            || (explanation.before.error(), explanation.before.error()),
            |(first, last)| (first.held_out_before.error, last.held_out_after.error),
        )),
        error: Some(explanation.after.error()),
        model: Some(explanation.after.estimate.applied_to(model)),
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
