//! What a method says about a campaign.

use hitch_campaign::Campaign;
use hitch_plant::Model;

/// What a method says.
#[derive(Debug, Clone, Default)]
pub struct Answer {
    /// Effects that it names, the first one first.
    pub named: Vec<String>,
    /// Effects that it says could be there instead of a named one.
    pub group: Vec<String>,
    /// Whether it says that something is left that it has no name for.
    pub unknown: bool,
    /// 95 % interval of the size of each effect that it names.
    pub intervals: Vec<(String, f64, f64)>,
    /// Probability that it states for each effect that it names.
    pub confidences: Vec<(String, f64)>,
    /// Error on runs that it was not fitted to, before and after, in sigmas.
    pub held_out: Option<(f64, f64)>,
    /// Error on the campaign with what was found, in sigmas, of methods that fit a model.
    pub error: Option<f64>,
    /// The model with what was found, of methods that fit one.
    pub model: Option<Model>,
}

/// What a method can say at all.
#[derive(Debug, Clone, Copy)]
pub struct Abilities {
    /// Names effects.
    pub names: bool,
    /// Owns up to what it has no name for.
    pub unknown: bool,
    /// States intervals.
    pub intervals: bool,
}

/// A way to find out what a model lacks.
pub trait Method: Sync {
    /// Name in tables.
    fn name(&self) -> &'static str;
    /// What it can say.
    fn abilities(&self) -> Abilities;
    /// What it says about a campaign, with the model to start from.
    fn answer(&self, campaign: &Campaign, model: &Model) -> Answer;
}
