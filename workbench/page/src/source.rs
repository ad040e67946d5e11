//! The campaign and the initial model of the page.

use std::fmt;
use std::path::PathBuf;
use std::sync::Arc;

use hitch_campaign::Campaign;
use hitch_identification::data::experiment::Experiment;
use hitch_plant::Model;

use hitch_output::error::Error;
use hitch_results::arguments::demonstration;
use hitch_results::base_model::fit::ShownBaseFit;
use hitch_results::comparison::Evaluated;
use hitch_results::explanation::Since;

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

/// Where a campaign is read from.
pub trait Origin: fmt::Debug + Send + Sync {
    /// Reads the campaign, and evaluates a first model on it.
    ///
    /// # Errors
    /// If the campaign is invalid.
    fn subject(self: Arc<Self>, model: Model) -> Result<Subject, Error>;
}

/// A campaign, and the model evaluated on it.
#[derive(Debug)]
pub struct Subject {
    origin: Arc<dyn Origin>,
    /// Description of the campaign; empty if it has none.
    pub description: String,
    /// The initial model.
    pub model: Model,
    /// The evaluation of the initial model.
    pub start: Arc<Evaluated>,
    /// The fit of the initial model's constants; `None` if they are as declared.
    pub fitted: Option<ShownBaseFit>,
}

impl Source {
    /// Reads the campaign and evaluates the model.
    ///
    /// # Errors
    /// If the campaign or the baseline is invalid.
    pub fn read(&self) -> Result<Subject, Error> {
        Arc::new(self.clone()).subject(self.model.clone())
    }
}

impl Origin for Source {
    fn subject(self: Arc<Self>, model: Model) -> Result<Subject, Error> {
        let campaign = match &self.campaign {
            Some(folder) => Campaign::load_with(folder, model.linkage())?,
            None => demonstration::campaign()?,
        };
        let Some(folder) = &self.baseline else {
            return Ok(Subject::new(self, &campaign, model));
        };
        let baseline = Campaign::load_with(folder, model.linkage())?;
        let since = Since::new(&baseline, model);
        let experiment = since.subtracted_from(&campaign);
        let beside = format!(
            "Measured values are less what the model leaves on {} in like states",
            baseline.name
        );
        Ok(Subject {
            description: match campaign.description.trim_end_matches('.') {
                "" => beside,
                own => format!("{own}. {beside}"),
            },
            start: Arc::new(Evaluated::prepared(experiment, &since.model)),
            model: since.model,
            fitted: None,
            origin: self,
        })
    }
}

impl Subject {
    /// Evaluates a model on a campaign.
    pub fn new(origin: Arc<dyn Origin>, campaign: &Campaign, model: Model) -> Self {
        Self {
            origin,
            fitted: None,
            description: campaign.description.clone(),
            start: Arc::new(Evaluated::new(campaign, &model)),
            model,
        }
    }

    /// The same campaign with another first model: noise, and angles that come from a travel, depend on it.
    ///
    /// # Errors
    /// If the campaign can no longer be read.
    pub fn exchanged(&self, model: Model) -> Result<Self, Error> {
        Arc::clone(&self.origin).subject(model)
    }

    /// The prepared campaign.
    pub fn experiment(&self) -> &Experiment {
        &self.start.experiment
    }
}
