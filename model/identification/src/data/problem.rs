//! The problem that all steps of an identification share.

use hitch_plant::Model;

use crate::data::experiment::Experiment;
use crate::data::limit::Limit;

/// Measured data and the model that is compared with them.
#[derive(Debug, Clone, Copy)]
pub struct Problem<'a> {
    /// The measured data.
    pub experiment: &'a Experiment,
    /// The model: its constants, and the effects that it had before the identification.
    pub model: &'a Model,
    /// Until when its fits go on.
    pub limit: Limit<'a>,
}

impl<'a> Problem<'a> {
    /// Measured data and a model.
    #[must_use]
    pub fn new(experiment: &'a Experiment, model: &'a Model) -> Self {
        Self {
            experiment,
            model,
            limit: Limit::default(),
        }
    }

    /// The same with a limit of the time of its fits.
    #[must_use]
    pub fn within(self, limit: Limit<'a>) -> Self {
        Self { limit, ..self }
    }

    /// The same model on other data.
    #[must_use]
    pub fn on(self, experiment: &'a Experiment) -> Self {
        Self { experiment, ..self }
    }
}
