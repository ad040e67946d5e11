//! An explanation together with what it was found from.
use hitch_model::Model;
use hitch_model::campaign::Campaign;
use hitch_model::identification::experiment::Experiment;
use hitch_model::identification::explain;

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
    /// The explanation as it is shown.
    pub shown: Explanation,
}

impl Found {
    /// Explains a campaign, saying on a terminal what is being tried.
    pub fn new(campaign: &Campaign, model: Model) -> Self {
        let progress = Progress::start(format!("reading {}", campaign.name));
        let experiment = Experiment::new(campaign, &model);
        let explanation = explain::explain(&experiment, &model, &|what| {
            progress.say(format!("trying {what}"))
        });
        let shown = Explanation::new(&experiment, &model, &explanation);
        Self {
            model,
            experiment,
            explanation,
            shown,
        }
    }

    /// The model with the effects that were found.
    pub fn rebuilt(&self, name: String) -> Model {
        rebuilt(&self.model, &self.explanation.after.estimate.effects, name)
    }
}
