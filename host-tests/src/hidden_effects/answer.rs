//! Answer of a method on a campaign.

use hitch_campaign::Campaign;
use hitch_plant::Model;

/// Answer of a method.
#[derive(Debug, Clone, Default)]
pub struct Answer {
    /// Effects that it names, the first one first.
    pub named: Vec<String>,
    /// Effects reported as possible alternatives of a named one.
    pub group: Vec<String>,
    /// Whether it reports a remaining error without a name.
    pub unknown: bool,
    /// 95 % interval of the size of each effect that it names.
    pub intervals: Vec<(String, f64, f64)>,
    /// Probability that it states for each effect that it names.
    pub confidences: Vec<(String, f64)>,
    /// Error on runs that it was not fitted to, before and after, in sigmas.
    pub held_out: Option<(f64, f64)>,
    /// Error on the campaign with the named effects, in sigma, for methods that fit a model.
    pub error: Option<f64>,
    /// The model with the named effects, for methods that fit one.
    pub model: Option<Model>,
}

/// Capabilities of a method.
#[derive(Debug, Clone, Copy)]
pub struct Abilities {
    /// Names effects.
    pub names: bool,
    /// Reports a remaining error without a name.
    pub unknown: bool,
    /// States intervals.
    pub intervals: bool,
}

/// A method that identifies the missing effects of a model.
pub trait Method: Sync {
    /// Name in tables.
    fn name(&self) -> &'static str;
    /// Its capabilities.
    fn abilities(&self) -> Abilities;
    /// Its answer on a campaign, with the initial model.
    fn answer(&self, campaign: &Campaign, model: &Model) -> Answer;
    /// Its answer on a campaign of a machine whose model was adopted from a baseline.
    fn answer_since(&self, _baseline: &Campaign, campaign: &Campaign, model: &Model) -> Answer {
        self.answer(campaign, model)
    }
}
