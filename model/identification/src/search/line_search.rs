//! Line search for the size of an effect without useful slopes at the end of a fit.
//!
//! The size of a sticking spool is determined to a few hundredths of a percent or not at all: at a slightly different
//! size the tenth jump occurs at another time. Slopes are useless there, and the earlier scan over all sizes found the
//! minimum with a small error, as the clocks still compensated for what was missing. Close to the optimum a fine search
//! follows. A piecewise constant cost needs a wide search: a descent ends at its first step. A run that ends just above the
//! ground shows nothing of it: its cost steps where the hitch of the model touches the ground too.

use hitch_plant::{AddedEffect, SizeResponse};

use crate::data::problem::Problem;
use crate::estimation::fit::{Fit, evaluate_weighted, refine};
use crate::parallel;
use crate::search::shape_starts::scaled;

/// Distance of the trial sizes to either side, as powers of e, for switching, stepped and located effects, and their number.
const DISTANCES_SWITCHING: [f64; 2] = [0.005, 0.000_8];
const DISTANCES_STEPPED: [f64; 2] = [1.0, 0.1];
const DISTANCES_LOCATED: [f64; 2] = [0.15, 0.015];
const TO_EITHER_SIDE: i32 = 10;

/// The better of a fit and of the fits from nearby sizes of an effect, by its index, unless its cost is smooth over its size.
pub(crate) fn line_searched(problem: Problem<'_>, fit: Fit, index: usize) -> Fit {
    let added = &fit.estimate.effects[index];
    let reaches = if !added.is_null() {
        reaches(added.effect.size_response(), problem.experiment.ringing)
    } else {
        &[]
    };
    reaches.iter().fold(fit, |fit, &reach| {
        let nearby = nearby(problem, &fit, index, reach);
        if nearby.cost < fit.cost {
            let refined = refine(problem, nearby.estimate.clone());
            better(nearby, refined)
        } else {
            fit
        }
    })
}

/// The one with the smaller cost.
fn better(one: Fit, other: Fit) -> Fit {
    if other.cost < one.cost { other } else { one }
}

/// Distances of the trial sizes. Without ringing a descent finds the size of a stepped effect, and a wide search only
/// finds the step that fits the noise best: intervals around it held the truth in 88 % of campaigns instead of 94 %.
fn reaches(response: SizeResponse, ringing: bool) -> &'static [f64] {
    match response {
        SizeResponse::Switching => &DISTANCES_SWITCHING,
        SizeResponse::Stepped if ringing => &DISTANCES_STEPPED,
        SizeResponse::Located => &DISTANCES_LOCATED,
        SizeResponse::Stepped | SizeResponse::Smooth => &[],
    }
}

/// The best of the nearby sizes, all other parameters fixed.
fn nearby(problem: Problem<'_>, fit: &Fit, index: usize, reach: f64) -> Fit {
    let fits = parallel::map(-TO_EITHER_SIDE..=TO_EITHER_SIDE, |step| {
        let mut estimate = fit.estimate.clone();
        let away = reach * f64::from(step) / f64::from(TO_EITHER_SIDE);
        estimate.effects[index] = resized(&estimate.effects[index], away.exp());
        evaluate_weighted(problem, estimate, fit.weights.clone())
    });
    fits.into_iter()
        .min_by(|a, b| a.cost.total_cmp(&b.cost))
        .expect("there are sizes")
}

/// An effect at a multiple of its size. A stepped effect keeps the product of its size and the distance of its shape
/// from one, which the data determine well.
fn resized(added: &AddedEffect, share: f64) -> AddedEffect {
    let mut resized = scaled(added, share);
    let parameters = added.effect.parameters();
    if let (SizeResponse::Stepped, [_, shape, ..]) = (added.effect.size_response(), parameters) {
        let left = (1.0 - added.values[1]) / share;
        resized.values[1] = (1.0 - left).clamp(shape.low, shape.high);
    }
    resized
}
