//! A second model on the campaign of a session, compared with the present one: an earlier step, or a model file.

use crate::source::Subject;
use hitch_identification::data::problem::Problem;
use hitch_identification::explanation::explain::fit_base;
use hitch_plant::Model;
use hitch_results::comparison::Evaluated;
use std::sync::Arc;

/// A second model, evaluated on the campaign of the session.
#[derive(Debug, Clone)]
pub struct Second {
    /// Its title.
    pub title: String,
    /// The model.
    pub model: Model,
    /// Its evaluation.
    pub evaluated: Arc<Evaluated>,
    /// Whether changes are those from the present model to this one; else they are those to the present model.
    pub is_after: bool,
}

impl Second {
    /// A model evaluated on the campaign, with the noise and the groups of the session.
    pub fn evaluate(subject: &Subject, title: String, model: Model) -> Self {
        let experiment = Arc::clone(&subject.start.experiment);
        let fit = fit_base(Problem::new(&experiment, &model));
        Self {
            title,
            evaluated: Arc::new(Evaluated::fitted(experiment, fit, &subject.model)),
            model,
            is_after: false,
        }
    }

    /// The model before and the model after, of this and the present one.
    pub fn ordered<'a>(&'a self, present: &'a Evaluated) -> [&'a Evaluated; 2] {
        if self.is_after {
            [present, &self.evaluated]
        } else {
            [&self.evaluated, present]
        }
    }
}
