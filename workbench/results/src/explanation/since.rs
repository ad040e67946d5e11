//! A campaign beside the baseline that its model was adopted from.

use hitch_campaign::Campaign;
use hitch_identification::data::experiment::Experiment;
use hitch_identification::data::problem::Problem;
use hitch_identification::explanation::baseline::Baseline;
use hitch_plant::Model;

/// An adopted model with what it leaves on its baseline.
#[derive(Debug, Clone)]
pub struct Since {
    /// The model.
    pub model: Model,
    baseline: Baseline,
}

impl Since {
    /// Compares an adopted model with its baseline.
    #[must_use]
    pub fn new(baseline: &Campaign, model: Model) -> Self {
        let experiment = Experiment::new(baseline, &model);
        Self {
            baseline: Baseline::new(Problem::new(&experiment, &model)),
            model,
        }
    }

    /// A new campaign less the baseline: what remains has changed since.
    #[must_use]
    pub fn subtracted_from(&self, new: &Campaign) -> Experiment {
        let experiment = Experiment::new(new, &self.model);
        self.baseline.subtracted_from(experiment)
    }
}
