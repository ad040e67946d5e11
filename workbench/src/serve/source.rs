//! What the page is about: a campaign and the model to begin with.

use std::path::PathBuf;
use std::sync::Arc;

use hitch_campaign::Campaign;
use hitch_identification::data::experiment::Experiment;
use hitch_plant::Model;

use crate::comparison::Evaluated;
use crate::demonstration;
use crate::error::Error;

/// Where campaign and model come from.
#[derive(Debug, Clone)]
pub struct Source {
    /// Folder of the campaign; `None` is the campaign that comes with the program.
    pub campaign: Option<PathBuf>,
    /// The model to begin with.
    pub model: Model,
}

/// A campaign that was read, and the model evaluated on it.
#[derive(Debug)]
pub struct Subject {
    /// One sentence about the campaign; empty if it has none.
    pub description: String,
    /// The model to begin with.
    pub model: Model,
    /// The model before any change.
    pub start: Arc<Evaluated>,
}

impl Source {
    /// Reads the campaign and evaluates the model.
    ///
    /// # Errors
    /// If the campaign is wrong.
    pub fn read(&self) -> Result<Subject, Error> {
        let campaign = match &self.campaign {
            Some(folder) => Campaign::load_with(folder, self.model.linkage())?,
            None => demonstration::campaign()?,
        };
        Ok(Subject {
            description: campaign.description.clone(),
            start: Arc::new(Evaluated::new(&campaign, &self.model)),
            model: self.model.clone(),
        })
    }
}

impl Subject {
    /// The campaign, ready.
    pub fn experiment(&self) -> &Experiment {
        &self.start.experiment
    }
}
