//! Profile-likelihood bounds of a parameter.
//!
//! The curvature of the cost at its minimum gives a confidence interval that holds where the plant is smooth. A spool
//! that breaks loose, or a hitch that touches the ground, does so at a discrete sample: the cost is then piecewise
//! constant, flat where its slope predicts a rise. There the interval ends where the cost has actually risen by the
//! predicted amount (profile likelihood, Venzon & Moolgavkar 1988), with all other free parameters re-optimised to
//! first order.

use crate::data::problem::Problem;
use crate::estimate::Shared;
use crate::estimation::fit::Fit;
use crate::estimation::jacobian::Jacobian;
use crate::estimation::nuisance_projection::NuisanceProjection;
use crate::estimation::residual_columns::huber_residuals;

/// Share of the predicted rise of the cost below which the quadratic approximation is rejected.
const ACCEPTED_SHARE: f64 = 0.5;

/// Factor on the required rise of the cost once the approximation is rejected: one step of the piecewise constant cost
/// is a single sample, and the noise of the current decides on which side of it a spool breaks loose.
const DISCRETE_RISE: f64 = 8.0;

/// Factor from one trial distance to the next.
const DISTANCE_FACTOR: f64 = 1.5;

/// Largest number of trial distances, and number of bisections between the last two.
const TRIALS: usize = 8;
const BISECTIONS: usize = 3;

/// The cost along one parameter of a fit.
pub struct ProfileLikelihood<'a> {
    /// The measured data and the model.
    pub problem: Problem<'a>,
    /// The fit, whose weights are used.
    pub fit: &'a Fit,
    /// The parameter.
    pub shared: Shared,
    /// Projection of all other free parameters, at the fit.
    pub projection: &'a NuisanceProjection<&'a Jacobian>,
}

impl ProfileLikelihood<'_> {
    /// End of the interval, relative to the fitted value, in the parameter's unit; `half` is the bound of the quadratic
    /// approximation, negative for the lower one, where it predicts a `rise` of the cost.
    #[must_use]
    pub fn end(&self, half: f64, rise: f64) -> f64 {
        if self.rise(half) >= ACCEPTED_SHARE * rise {
            return half;
        }
        let exceeds = |away: f64| self.rise(away) >= DISCRETE_RISE * rise;
        let (mut near, mut far) = (half, DISTANCE_FACTOR * half);
        for _ in 0..TRIALS {
            if exceeds(far) {
                break;
            }
            (near, far) = (far, DISTANCE_FACTOR * far);
        }
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (near + far);
            if exceeds(middle) {
                far = middle;
            } else {
                near = middle;
            }
        }
        far
    }

    /// Rise of the cost with the parameter `away` from its fitted value.
    fn rise(&self, away: f64) -> f64 {
        let mut moved = self.fit.estimate.clone();
        let (low, high) = moved.range(self.shared);
        let value = moved.get(self.shared) + away;
        if value < low || value > high {
            return f64::INFINITY;
        }
        moved.set(self.shared, value);
        let residuals = huber_residuals(self.problem, &self.fit.weights, &moved);
        self.projection.cost_after(&residuals) - self.projection.here()
    }
}
