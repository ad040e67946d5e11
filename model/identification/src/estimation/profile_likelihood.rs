//! How far a parameter may go before the cost tells.
//!
//! The slope of the cost at its least promises an interval, and keeps the promise where the plant is smooth. A spool
//! that breaks loose, or a hitch that comes down on the ground, does so at one sample or the next: the cost is a
//! staircase, flat where its slope says steep. There the interval ends where the cost has risen by as much as the
//! promise said it would (profile likelihood, Venzon & Moolgavkar 1988), all that is free besides adapting to first
//! order.

use hitch_plant::Model;

use crate::data::experiment::Experiment;
use crate::estimate::Shared;
use crate::estimation::fit::Fit;
use crate::estimation::jacobian::{Jacobian, huber_residuals};
use crate::estimation::nuisance_projection::NuisanceProjection;

/// A rise of the cost that is less than this share of the promised one breaks the promise.
const KEPT: f64 = 0.5;

/// Once it is broken, the cost has to rise by so many times what was promised: a step of a staircase is one sample, and
/// the noise of the current decides on which side of it a spool breaks loose.
const BROKEN: f64 = 8.0;

/// How much farther each look goes than the one before.
const FARTHER: f64 = 1.5;

/// Most looks, and how often the way between the last two is halved.
const LOOKS: usize = 8;
const HALVINGS: usize = 3;

/// The cost along one parameter of a fit.
pub struct Profile<'a> {
    /// What was measured.
    pub experiment: &'a Experiment,
    /// The model without effects.
    pub model: &'a Model,
    /// The fit, whose weights hold.
    pub fit: &'a Fit,
    /// Which parameter.
    pub shared: Shared,
    /// All that is free besides it, at the fit.
    pub projection: &'a NuisanceProjection<&'a Jacobian>,
}

impl Profile<'_> {
    /// Where the interval ends that the slopes promise `half` away, in the parameter's unit, negative for downwards, and
    /// at a cost that is higher by `rise`.
    #[must_use]
    pub fn end(&self, half: f64, rise: f64) -> f64 {
        if self.rise(half) >= KEPT * rise {
            return half;
        }
        let told = |away: f64| self.rise(away) >= BROKEN * rise;
        let (mut near, mut far) = (half, FARTHER * half);
        for _ in 0..LOOKS {
            if told(far) {
                break;
            }
            (near, far) = (far, FARTHER * far);
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (near + far);
            if told(middle) {
                far = middle;
            } else {
                near = middle;
            }
        }
        far
    }

    /// Rise of the cost where the parameter is `away` from its fitted value.
    fn rise(&self, away: f64) -> f64 {
        let mut moved = self.fit.estimate.clone();
        let (low, high) = moved.range(self.shared);
        let value = moved.get(self.shared) + away;
        if value < low || value > high {
            return f64::INFINITY;
        }
        moved.set(self.shared, value);
        let residuals = huber_residuals(self.experiment, self.model, &self.fit.weights, &moved);
        self.projection.cost_after(&residuals) - self.projection.here()
    }
}
