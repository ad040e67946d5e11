//! Effects that explain a campaign as well as the named one, and how far apart the two are on it.

use hitch_plant::{AddedEffect, Effect, Model};

use crate::data::experiment::Experiment;
use crate::estimate::Shared;
use crate::estimation::fit::Fit;
use crate::estimation::jacobian::{Jacobian, difference, dot, residuals};
use crate::estimation::nuisance_projection::NuisanceProjection;

/// An effect that would explain the campaign as well in place of another.
#[derive(Debug, Clone)]
pub struct Alternative {
    /// Which effect.
    pub effect: &'static dyn Effect,
    /// Angle between the two effects' signatures at their fitted sizes, all that is free besides projected out, degree:
    /// 0 if they are one on this campaign, 90 if they have nothing in common.
    pub angle_deg: f64,
    /// Fitted values of its parameters, in their units.
    pub values: Vec<f64>,
    /// By how much it is likelier than the named one, as a likelihood ratio with its parameters paid for; negative:
    /// less likely.
    pub likelier: f64,
    /// Error of the model with it instead.
    pub error_after: f64,
    /// The model with it instead, as fitted; it is the last of the effects.
    pub fit: Fit,
}

impl Alternative {
    /// An effect that was fitted, last of all, in place of the last one of `whole`, and is so much likelier.
    #[must_use]
    pub fn new(
        experiment: &Experiment,
        model: &Model,
        whole: &Fit,
        (fit, likelier): (Fit, f64),
    ) -> Option<Self> {
        let added = fit.estimate.effects.last()?.clone();
        Some(Self {
            effect: added.effect,
            angle_deg: angle_deg(experiment, model, whole, &added)?,
            values: added.values,
            likelier,
            error_after: fit.error(),
            fit,
        })
    }
}

/// Angle between what the last effect of a fit does to the campaign and what `other` would do in its place, degree,
/// both without what the other effects, the loads and the clocks can imitate. `None` without a last effect.
#[must_use]
pub fn angle_deg(
    experiment: &Experiment,
    model: &Model,
    whole: &Fit,
    other: &AddedEffect,
) -> Option<f64> {
    Some(Place::new(experiment, model, whole)?.angle_deg(other))
}

/// The place of the last effect of a fit, for others to be tried in.
pub struct Place<'a> {
    experiment: &'a Experiment,
    model: &'a Model,
    whole: &'a Fit,
    last: usize,
    /// All that is free besides the last effect.
    projection: NuisanceProjection<Jacobian>,
    /// Residuals with nothing in the place.
    empty: Vec<Vec<f64>>,
    /// What the last effect does that nothing else can imitate.
    own: Vec<Vec<f64>>,
}

impl<'a> Place<'a> {
    /// The place of the last effect; `None` if there is none.
    #[must_use]
    pub fn new(experiment: &'a Experiment, model: &'a Model, whole: &'a Fit) -> Option<Self> {
        let last = whole.estimate.effects.len().checked_sub(1)?;
        let jacobian = Jacobian::new(experiment, model, &whole.weights, &whole.estimate);
        let jacobian = without(jacobian, last);
        let mut place = Self {
            experiment,
            model,
            whole,
            last,
            projection: NuisanceProjection::new(jacobian, &whole.estimate, 0..0),
            empty: Vec::new(),
            own: Vec::new(),
        };
        place.empty = place.residuals(AddedEffect::null(whole.estimate.effects[last].effect));
        place.own = place.signature(&whole.residuals);
        Some(place)
    }

    /// Angle between the signatures of the effect that is there and of `other` in its place, degree.
    #[must_use]
    pub fn angle_deg(&self, other: &AddedEffect) -> f64 {
        self.likeness(other).0
    }

    /// [`Place::angle_deg`], and how many times `other` comes nearest to the effect that is there.
    #[must_use]
    pub fn likeness(&self, other: &AddedEffect) -> (f64, f64) {
        let others = self.signature(&self.residuals(other.clone()));
        let square = product(&others, &others);
        let share = if square > 0.0 {
            product(&self.own, &others) / square
        } else {
            1.0
        };
        (between_deg(&self.own, &others), share)
    }

    /// Fall of the cost that only the effect which is there explains, to first order.
    #[must_use]
    pub fn explained(&self) -> f64 {
        product(&self.own, &self.own)
    }

    /// What is done to the campaign by what leaves some residuals, less what all that is free besides can imitate.
    fn signature(&self, present: &[Vec<f64>]) -> Vec<Vec<f64>> {
        self.projection.project(difference(&self.empty, present))
    }

    fn residuals(&self, effect: AddedEffect) -> Vec<Vec<f64>> {
        let mut estimate = self.whole.estimate.clone();
        estimate.effects[self.last] = effect;
        residuals(self.experiment, self.model, &self.whole.weights, &estimate)
    }
}

/// A Jacobian without the columns of one effect.
fn without(mut jacobian: Jacobian, effect: usize) -> Jacobian {
    let kept: Vec<bool> = jacobian
        .shared
        .iter()
        .map(|shared| !matches!(shared, Shared::Effect(of, _) if *of == effect))
        .collect();
    let retain = |index: &mut usize| {
        *index += 1;
        kept[*index - 1]
    };
    for run in &mut jacobian.runs {
        let mut index = 0;
        run.shared.retain(|_| retain(&mut index));
    }
    let mut index = 0;
    jacobian.shared.retain(|_| retain(&mut index));
    jacobian
}

fn product(a: &[Vec<f64>], b: &[Vec<f64>]) -> f64 {
    a.iter().zip(b).map(|(a, b)| dot(a, b)).sum()
}

/// Angle between two signatures, degree; a right one if either is nothing.
fn between_deg(a: &[Vec<f64>], b: &[Vec<f64>]) -> f64 {
    let (aa, bb, ab) = (product(a, a), product(b, b), product(a, b));
    if aa <= 0.0 || bb <= 0.0 {
        return 90.0;
    }
    // The arc cosine loses half of the digits of a small angle; the arc tangent does not.
    let sine_square = (1.0 - ab / aa * (ab / bb)).max(0.0);
    sine_square
        .sqrt()
        .atan2(ab.abs() / (aa * bb).sqrt())
        .to_degrees()
}

#[cfg(test)]
mod tests {
    use super::between_deg;

    #[test]
    fn angles_are_those_of_geometry() {
        let a = vec![vec![2.0, 0.0], vec![0.0]];
        for (degrees, b) in [
            (0.0, vec![vec![-3.0, 0.0], vec![0.0]]),
            (45.0, vec![vec![1.0, 0.0], vec![1.0]]),
            (90.0, vec![vec![0.0, 1.0], vec![0.0]]),
            (90.0, vec![vec![0.0, 0.0], vec![0.0]]),
        ] {
            assert!((between_deg(&a, &b) - degrees).abs() < 1e-6);
        }
    }
}
