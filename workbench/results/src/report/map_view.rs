//! What an error map has beside its cells: its headings, and the stretch to which a cell leads.

use hitch_plant::Channel;
use schemars::JsonSchema;
use serde::Serialize;

use crate::comparison::{Evaluated, Grouping};

/// A grouping of the rows, with its title.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub struct GroupingTitle {
    /// The grouping.
    pub by: Grouping,
    /// Its title.
    pub title: &'static str,
}

impl GroupingTitle {
    /// Every grouping.
    pub fn all() -> Vec<Self> {
        let titled = |by: Grouping| Self {
            by,
            title: by.title(),
        };
        Grouping::ALL.map(titled).to_vec()
    }
}

/// A column: a measured channel, with the error of the model.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct MeasuredChannel {
    /// Key.
    pub key: &'static str,
    /// Name for a reader.
    pub title: &'static str,
    /// Unit of its values.
    pub unit: &'static str,
    /// Error, sigma.
    pub error: f64,
    /// One sigma of the instrument, in the unit.
    pub noise: f64,
}

impl MeasuredChannel {
    /// The measured channels of a campaign.
    pub fn all(evaluated: &Evaluated) -> Vec<Self> {
        let measured = |channel: Channel| Self {
            key: channel.key(),
            title: channel.title(),
            unit: channel.unit(),
            error: evaluated.fit.channel_error(channel.index()),
            noise: evaluated.experiment.noise[channel.index()],
        };
        let channels = Channel::ALL.into_iter();
        let channels = channels.filter(|channel| evaluated.experiment.measures(*channel));
        channels.map(measured).collect()
    }
}

/// A stretch of time of a run.
#[derive(Debug, Clone, Serialize, JsonSchema)]
#[schemars(rename = "Located{S}")]
pub struct Located<S> {
    /// Index of the run.
    pub run: usize,
    /// The stretch.
    pub stretch: S,
}

impl<S> From<(usize, S)> for Located<S> {
    fn from((run, stretch): (usize, S)) -> Self {
        Self { run, stretch }
    }
}
