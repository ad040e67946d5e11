//! The campaign and the initial model of the page.

use std::path::PathBuf;
use std::sync::Arc;

use hitch_campaign::Campaign;
use hitch_identification::data::experiment::Experiment;
use hitch_plant::Model;

use crate::comparison::Evaluated;
use crate::demonstration;
use crate::error::Error;
use crate::explanation::Since;

/// Sources of campaign and model.
#[derive(Debug, Clone)]
pub struct Source {
    /// Folder of the campaign; `None` is the demonstration campaign.
    pub campaign: Option<PathBuf>,
    /// The initial model.
    pub model: Model,
    /// Folder of the campaign that the model was adopted from: what it leaves there is subtracted.
    pub baseline: Option<PathBuf>,
}

/// A campaign, and the model evaluated on it.
#[derive(Debug)]
pub struct Subject {
    /// Description of the campaign; empty if it has none.
    pub description: String,
    /// The initial model.
    pub model: Model,
    /// The evaluation of the initial model.
    pub start: Arc<Evaluated>,
}

impl Source {
    /// Reads the campaign and evaluates the model.
    ///
    /// # Errors
    /// If the campaign or the baseline is invalid.
    pub fn read(&self) -> Result<Subject, Error> {
        let campaign = match &self.campaign {
            Some(folder) => Campaign::load_with(folder, self.model.linkage())?,
            None => demonstration::campaign()?,
        };
        let Some(folder) = &self.baseline else {
            return Ok(Subject::new(&campaign, self.model.clone()));
        };
        let baseline = Campaign::load_with(folder, self.model.linkage())?;
        let since = Since::new(&baseline, self.model.clone());
        let (experiment, name) = (since.subtracted_from(&campaign), &baseline.name);
        Ok(Subject {
            description: format!(
                "{} Measured values are less what the model leaves on {name}, where that has the same states.",
                campaign.description
            ),
            start: Arc::new(Evaluated::prepared(experiment, &since.model)),
            model: since.model,
        })
    }
}

impl Subject {
    /// Evaluates a model on a campaign.
    pub fn new(campaign: &Campaign, model: Model) -> Self {
        Self {
            description: campaign.description.clone(),
            start: Arc::new(Evaluated::new(campaign, &model)),
            model,
        }
    }

    /// The prepared campaign.
    pub fn experiment(&self) -> &Experiment {
        &self.start.experiment
    }
}
