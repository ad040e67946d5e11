//! An explanation together with what it was found from.
use hitch_model::Model;
use hitch_model::campaign::Campaign;
use hitch_model::effects::Effect;
use hitch_model::identification::experiment::Experiment;
use hitch_model::identification::explain;
use hitch_model::identification::subset::Options;
use hitch_model::identification::suggestion::{Suggestion, suggest};
use hitch_model::identification::whereabouts::Profile;

use super::{Explanation, rebuilt};
use crate::progress::Progress;

/// An explanation with everything that belongs to it.
#[derive(Debug, Clone)]
pub struct Found {
    /// The model it began with.
    pub model: Model,
    /// The campaign, ready.
    pub experiment: Experiment,
    /// The explanation as the identification gives it.
    pub explanation: explain::Explanation,
    /// Where what stays unexplained is largest, along the first signal that it goes with.
    pub rest: Option<Profile>,
    /// A term for it.
    pub suggestion: Option<Suggestion>,
    /// The explanation as it is shown.
    pub shown: Explanation,
}

impl Found {
    /// Explains a campaign, saying on a terminal what is being tried.
    pub fn new(campaign: &Campaign, model: Model, options: Options) -> Self {
        let progress = Progress::start(format!("reading {}", campaign.name));
        let experiment = Experiment::new(campaign, &model);
        let explanation = explain::explain_with(&experiment, &model, options, &|what| {
            progress.say(format!("trying {what}"))
        });
        let rest = explanation
            .rest
            .depends_on
            .first()
            .and_then(|signal| Profile::new(&experiment, &explanation.after, signal));
        let suggestion = (!options.is_over()).then(|| {
            suggest(&experiment, &model, &explanation, &|what| {
                progress.say(format!("trying a term of its own, {what}"))
            })
        });
        let suggestion = suggestion.flatten();
        let mut shown = Explanation::new(&experiment, &model, &explanation);
        shown.unexplained.whereabouts = rest.as_ref().map(ToString::to_string);
        if let Some(suggestion) = &suggestion {
            shown.unexplained.suggest(suggestion);
        }
        Self {
            rest,
            suggestion,
            model,
            experiment,
            explanation,
            shown,
        }
    }

    /// The model with the effects that were found; a suggested term is defined in it, but not added.
    pub fn rebuilt(&self, name: String) -> Model {
        let mut model = rebuilt(&self.model, &self.explanation.after.estimate.effects, name);
        let defined: Vec<&str> = model.terms.iter().map(|term| term.id()).collect();
        if let Some(suggestion) = &self.suggestion
            && !defined.contains(&suggestion.term.id())
        {
            model.terms.push(suggestion.term);
        }
        model
    }
}
