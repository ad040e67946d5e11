//! Effects that a campaign could not detect.
//!
//! "Nothing missing" only covers detectable effects. The slip of a pump shows if the demand exceeds its delivery, a
//! relief valve at a stop. Duty cycles contain neither, so their verdict says nothing about these effects.

use hitch_plant::{AddedEffect, Channel, Effect};

use crate::data::experiment::Experiment;
use crate::data::problem::Problem;
use crate::estimation::fit::Fit;
use crate::estimation::jacobian::Jacobian;
use crate::estimation::nuisance_projection::NuisanceProjection;
use crate::estimation::residual_columns::{difference, huber, huber_residuals};
use crate::parallel;
use crate::search::candidates::absent;
use crate::selection::evidence::{VISIBLE, detectability};

/// An effect of typical size that a campaign could not detect.
#[derive(Debug, Clone)]
pub struct Undetected {
    /// The effect.
    pub effect: &'static dyn Effect,
    /// Root mean square of its signature with all free parameters projected out, in sigmas.
    pub detectability: f64,
    /// Channels that it acts on and that the campaign lacks.
    pub missing: Vec<Channel>,
}

/// Effects, at their typical size, whose signature beyond the free parameters of a fit is too small; by increasing
/// detectability.
#[must_use]
pub fn undetected(problem: Problem<'_>, fit: &Fit) -> Vec<Undetected> {
    let Problem {
        experiment, model, ..
    } = problem;
    let experiment =
        &experiment.coarse_in_time(&fit.estimate.applied_to(model), &fit.estimate.nuisances);
    let base = huber(fit.residuals.clone());
    let (weights, estimate) = (&fit.weights, &fit.estimate);
    let jacobian = Jacobian::new(problem, weights, estimate);
    let projection = NuisanceProjection::new(&jacobian, estimate, 0..0);
    let effects = absent(model, estimate).into_iter();
    let plain = effects.filter(|effect| effect.form().is_none());
    let mut undetected = parallel::map(plain, |effect| {
        let mut with = estimate.clone();
        with.effects.push(AddedEffect::typical(effect));
        let with = huber_residuals(problem, weights, &with);
        let (left, penalty) = projection.project_within_range(difference(&base, &with));
        Undetected {
            effect,
            detectability: detectability(&left, penalty, weights.count()),
            missing: missing(experiment, effect),
        }
    });
    undetected.retain(|undetected| undetected.detectability < VISIBLE);
    undetected.sort_by(|a, b| a.detectability.total_cmp(&b.detectability));
    undetected
}

/// Channels that an effect acts on and that no run contains.
fn missing(experiment: &Experiment, effect: &dyn Effect) -> Vec<Channel> {
    let channels = effect.channels().iter().copied();
    channels
        .filter(|channel| !experiment.measures(*channel))
        .collect()
}
