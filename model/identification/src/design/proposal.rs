//! A proposed manoeuvre in full: the runs to log, and what the models expect of them.

use hitch_campaign::Run;
use hitch_plant::Model;

use crate::design::plan::Manoeuvre;

/// Sample rate of the expected logs, Hz.
const RATE_HZ: f64 = 50.0;

/// A manoeuvre, and the models that it decides between.
#[derive(Debug, Clone)]
pub struct Proposal {
    /// The manoeuvre.
    pub manoeuvre: Manoeuvre,
    /// The fitted models of the two rivals that it distinguishes first; the present model alone if it explores.
    pub models: Vec<Expecting>,
    /// Which channels the campaign measures, by `Channel::index`.
    pub channels: [bool; 4],
}

/// A model that expects something of a manoeuvre.
#[derive(Debug, Clone)]
pub struct Expecting {
    /// Title of the effect that it has, or "the present model".
    pub title: String,
    /// The model.
    pub model: Model,
}

impl Proposal {
    /// The noise-free logs that a model expects, one per run, at 50 Hz.
    #[must_use]
    pub fn expected(&self, of: &Expecting) -> Vec<Run> {
        self.manoeuvre.log(&of.model, RATE_HZ, self.channels)
    }
}
