//! Confounded alternatives of an effect, and the angle between their signatures.

use hitch_plant::{AddedEffect, Effect};

use crate::data::problem::Problem;
use crate::estimate::Shared;
use crate::estimation::fit::Fit;
use crate::estimation::jacobian::Jacobian;
use crate::estimation::nuisance_projection::NuisanceProjection;
use crate::estimation::residual_columns::{difference, dot, residuals};

/// A confounded alternative: an effect that would explain the campaign as well in place of another.
#[derive(Debug, Clone)]
pub struct Alternative {
    /// The effect.
    pub effect: &'static dyn Effect,
    /// Angle between the projected signatures of the two effects at their fitted sizes, degree: 0 if they are identical
    /// on this campaign, 90 if they are orthogonal.
    pub angle_deg: f64,
    /// Fitted values of its parameters, in their units.
    pub values: Vec<f64>,
    /// Penalised likelihood ratio relative to the named effect; negative if less probable.
    pub relative_likelihood_ratio: f64,
    /// Error of the model with it in place of the named effect.
    pub error_after: f64,
    /// The model with it in place of the named effect, fitted.
    pub fit: Fit,
}

impl Alternative {
    /// An effect, by its index in `fit`, that was fitted in place of the one of `replacement`.
    #[must_use]
    pub fn new(
        replacement: &Replacement,
        fit: Fit,
        index: usize,
        relative_likelihood_ratio: f64,
    ) -> Self {
        let added = fit.estimate.effects[index].clone();
        Self {
            effect: added.effect,
            angle_deg: replacement.angle_deg(&added),
            values: added.values,
            relative_likelihood_ratio,
            error_after: fit.error(),
            fit,
        }
    }
}

/// An effect of a fit, for comparison with other effects in its place.
pub struct Replacement<'a> {
    /// The measured data and the model.
    problem: Problem<'a>,
    whole: &'a Fit,
    index: usize,
    /// Projection of all other free parameters.
    projection: NuisanceProjection<Jacobian>,
    /// Residuals without the effect.
    empty: Vec<Vec<f64>>,
    /// Projected signature of the effect.
    own: Vec<Vec<f64>>,
}

impl<'a> Replacement<'a> {
    /// The effect with an index in a fit.
    #[must_use]
    pub fn new(problem: Problem<'a>, whole: &'a Fit, index: usize) -> Self {
        let jacobian = Jacobian::new(problem, &whole.weights, &whole.estimate);
        let jacobian = without(jacobian, index);
        let mut replacement = Self {
            problem,
            whole,
            index,
            projection: NuisanceProjection::new(jacobian, &whole.estimate, 0..0),
            empty: Vec::new(),
            own: Vec::new(),
        };
        replacement.empty =
            replacement.residuals(AddedEffect::null(whole.estimate.effects[index].effect));
        replacement.own = replacement.signature(&whole.residuals);
        replacement
    }

    /// Angle between the projected signatures of the effect and of `other` in its place, degree, with the other effects,
    /// the loads and the clocks projected out.
    #[must_use]
    pub fn angle_deg(&self, other: &AddedEffect) -> f64 {
        self.likeness(other).0
    }

    /// [`Replacement::angle_deg`], and the multiple of `other` that is closest to the effect.
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

    /// Cost reduction that only the effect explains, to first order.
    #[must_use]
    pub fn explained(&self) -> f64 {
        product(&self.own, &self.own)
    }

    /// Projected signature of a change that leads to the residuals `present`.
    fn signature(&self, present: &[Vec<f64>]) -> Vec<Vec<f64>> {
        self.projection.project(difference(&self.empty, present))
    }

    fn residuals(&self, effect: AddedEffect) -> Vec<Vec<f64>> {
        let mut estimate = self.whole.estimate.clone();
        estimate.effects[self.index] = effect;
        residuals(self.problem, &self.whole.weights, &estimate)
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

/// Angle between two signatures, degree; 90 if either is zero.
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
