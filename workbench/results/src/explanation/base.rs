//! What the campaigns of a command are compared with: a model alone, or beside its baseline.

use std::path::Path;

use hitch_campaign::Campaign;
use hitch_identification::data::experiment::Experiment;
use hitch_plant::Model;

use crate::arguments::baseline::BaselineArg;
use crate::arguments::model::ModelArg;
use crate::explanation::Since;
use hitch_output::error::Error;

/// What campaigns are compared with.
pub enum Base<'a> {
    /// A model.
    Alone(&'a ModelArg, Model),
    /// A model beside its baseline.
    Since(Box<Since>),
}

/// A campaign that has been read, and what it is compared with.
pub struct Posed {
    /// The model, in the form that is nearer to the campaign.
    pub model: Model,
    /// The campaign as it was read.
    pub campaign: Campaign,
    /// The campaign as it is compared, less the baseline.
    pub experiment: Experiment,
}

impl<'a> Base<'a> {
    /// Reads the model, and compares it with the baseline if there is one.
    ///
    /// # Errors
    /// If the model or the baseline is invalid.
    pub fn load(model: &'a ModelArg, baseline: &BaselineArg) -> Result<Self, Error> {
        match baseline.folder() {
            Some(folder) => {
                let read = model.load()?;
                let campaign = Campaign::load_with(folder, read.linkage())?;
                let model = model.nearer(read, &campaign);
                Ok(Self::Since(Box::new(Since::new(&campaign, model))))
            }
            None => Ok(Self::Alone(model, model.load()?)),
        }
    }

    /// The model as it was read.
    #[must_use]
    pub fn model(&self) -> &Model {
        match self {
            Self::Alone(_, model) => model,
            Self::Since(since) => &since.model,
        }
    }

    /// Reads a campaign.
    ///
    /// # Errors
    /// If the campaign is invalid.
    pub fn posed(&self, folder: &Path) -> Result<Posed, Error> {
        let campaign = Campaign::load_with(folder, self.model().linkage())?;
        let (model, experiment) = match self {
            Self::Alone(arg, model) => {
                let model = arg.nearer(model.clone(), &campaign);
                let experiment = Experiment::new(&campaign, &model);
                (model, experiment)
            }
            Self::Since(since) => (since.model.clone(), since.subtracted_from(&campaign)),
        };
        Ok(Posed {
            model,
            campaign,
            experiment,
        })
    }
}
