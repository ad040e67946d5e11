//! What a campaign could not show if it were there.
//!
//! "Nothing missing" only holds for what would have been seen. A pump that slips shows where the demand exceeds what
//! it delivers, a relief valve at a stop: duty cycles have neither, and then a clean answer says nothing of them.

use hitch_plant::{AddedEffect, Channel, Effect, Model};
use rayon::prelude::*;

use crate::data::experiment::Experiment;
use crate::estimation::fit::Fit;
use crate::estimation::jacobian::{Jacobian, difference, huber, huber_residuals};
use crate::estimation::nuisance_projection::NuisanceProjection;
use crate::search::candidates::absent;
use crate::selection::evidence::{VISIBLE, detectability};

/// An effect of typical size that a campaign would not show.
#[derive(Debug, Clone)]
pub struct Undetected {
    /// Which effect.
    pub effect: &'static dyn Effect,
    /// Root mean square of what it would change and nothing that is free could imitate, in sigmas.
    pub detectability: f64,
    /// Channels that it shows in and the campaign does not have.
    pub missing: Vec<Channel>,
}

/// Effects, at their typical size, that a campaign would not show beside what a fit has; the faintest first.
#[must_use]
pub fn undetected(experiment: &Experiment, model: &Model, fit: &Fit) -> Vec<Undetected> {
    let experiment =
        &experiment.coarse_in_time(&fit.estimate.applied_to(model), &fit.estimate.nuisances);
    let base = huber(fit.residuals.clone());
    let (weights, estimate) = (&fit.weights, &fit.estimate);
    let jacobian = Jacobian::new(experiment, model, weights, estimate);
    let projection = NuisanceProjection::new(&jacobian, estimate, 0..0);
    let mut undetected: Vec<Undetected> = absent(model, estimate)
        .into_par_iter()
        .filter(|effect| effect.form().is_none())
        .map(|effect| {
            let mut with = estimate.clone();
            with.effects.push(AddedEffect::typical(effect));
            let with = huber_residuals(experiment, model, weights, &with);
            let (left, penalty) = projection.project_within_range(difference(&base, &with));
            Undetected {
                effect,
                detectability: detectability(&left, penalty, weights.count()),
                missing: missing(experiment, effect),
            }
        })
        .filter(|undetected| undetected.detectability < VISIBLE)
        .collect();
    undetected.sort_by(|a, b| a.detectability.total_cmp(&b.detectability));
    undetected
}

/// Channels that an effect shows in and no run has.
fn missing(experiment: &Experiment, effect: &dyn Effect) -> Vec<Channel> {
    let channels = effect.channels().iter().copied();
    channels
        .filter(|channel| !experiment.measures(*channel))
        .collect()
}
