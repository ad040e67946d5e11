//! Answer of the identification on a campaign.

use hitch_plant::Model;

/// Answer of the identification.
#[derive(Debug, Clone)]
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
    pub held_out: (f64, f64),
    /// Error on the campaign with the named effects, in sigma.
    pub error: f64,
    /// The model with the named effects.
    pub model: Model,
}
