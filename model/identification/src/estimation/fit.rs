//! Output-error fits of the effects, the clocks and each run's nuisance parameters.
//!
//! The fit compares simulated trajectories, not one-step predictions: those feed the measured pressure back and hide
//! leakage and friction.

use crate::data::problem::Problem;
use crate::estimate::Estimate;
use crate::estimation::clock_synchronisation::synchronised;
use crate::estimation::least_squares::{Descent, Moves, descend};
use crate::estimation::residual_columns::{huber, residuals, square_sum};
use crate::estimation::slow_columns::load_steps;
use crate::residuals::whitening::Weights;

/// Factors on the weights of the channels (pump pressure, cylinder pressure, flow, angle) in the coarse round. Ringing
/// pressures create local minima, so the first round relies on flow and angle.
pub(crate) const COARSE: [f64; 4] = [0.04, 0.04, 0.15, 0.25];

/// Iterations of the coarse and of each fine round.
const COARSE_ITERATIONS: usize = 4;
const FINE_ITERATIONS: usize = 12;

/// Iterations from a start that has almost converged.
const LAST_ITERATIONS: usize = 2;

/// A fitted model.
#[derive(Debug, Clone)]
pub struct Fit {
    /// The fitted values.
    pub estimate: Estimate,
    /// Weights at these values.
    pub weights: Weights,
    /// Whitened residuals of each run, channel after channel.
    pub residuals: Vec<Vec<f64>>,
    /// Sum of the Huber losses plus the cost of the priors.
    pub cost: f64,
}

/// Sums of squared whitened residuals and numbers of samples, by channel.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ErrorSums {
    squares: [f64; 4],
    counts: [usize; 4],
}

impl ErrorSums {
    /// Sums over all runs of a fit.
    #[must_use]
    pub fn of(fit: &Fit) -> Self {
        Self::summed(&fit.residuals, fit.weights.counts)
    }

    /// Sums over all runs of a fit, with the residuals after Huber's loss.
    #[must_use]
    pub fn with_huber_loss(fit: &Fit) -> Self {
        Self::summed(&huber(fit.residuals.clone()), fit.weights.counts)
    }

    fn summed(residuals: &[Vec<f64>], counts: [usize; 4]) -> Self {
        let mut sums = Self {
            squares: [0.0; 4],
            counts,
        };
        for run in residuals {
            let samples = run.len() / 4;
            for (channel, square) in sums.squares.iter_mut().enumerate() {
                let part = &run[channel * samples..(channel + 1) * samples];
                *square += part.iter().map(|e| e * e).sum::<f64>();
            }
        }
        sums
    }

    /// Sum over several parts.
    #[must_use]
    pub fn total(parts: &[Self]) -> Self {
        let mut total = Self::default();
        for part in parts {
            for channel in 0..4 {
                total.squares[channel] += part.squares[channel];
                total.counts[channel] += part.counts[channel];
            }
        }
        total
    }

    /// Root mean square of one channel; NaN without samples.
    #[must_use]
    pub fn channel(&self, channel: usize) -> f64 {
        (self.squares[channel] / self.counts[channel] as f64).sqrt()
    }

    /// Root mean square over all channels that have samples, with equal weight per channel; NaN without any.
    #[must_use]
    pub fn error(&self) -> f64 {
        let compared: Vec<f64> = (0..4)
            .filter(|&channel| self.counts[channel] > 0)
            .map(|channel| self.channel(channel).powi(2))
            .collect();
        (compared.iter().sum::<f64>() / compared.len() as f64).sqrt()
    }
}

impl Fit {
    /// Costs of this fit and of another one under common weights: the wider standard deviation of either at each sample.
    /// Weights depend on the model. A sticking spool does not follow the noise of the currents, and claims more precision
    /// than another model; it jumps on slow ramps, where it claims less.
    #[must_use]
    pub fn compared(&self, other: &Self) -> [f64; 2] {
        let common = self.weights.wider(&other.weights);
        [self, other].map(|fit| {
            let residuals = fit.weights.whitened_with(&common, &fit.residuals);
            square_sum(&huber(residuals)) + fit.estimate.prior_cost()
        })
    }

    /// Error of one channel by its index: root mean square of its whitened residuals; NaN without samples.
    #[must_use]
    pub fn channel_error(&self, channel: usize) -> f64 {
        ErrorSums::of(self).channel(channel)
    }

    /// Error over all channels, with equal weight per channel.
    #[must_use]
    pub fn error(&self) -> f64 {
        ErrorSums::of(self).error()
    }

    /// Mean square of the residuals, at least one, that of noise alone.
    #[must_use]
    pub fn variance(&self) -> f64 {
        (square_sum(&self.residuals) / self.weights.count() as f64).max(1.0)
    }
}

/// Evaluates an estimate without changing it.
#[must_use]
pub fn evaluate(problem: Problem<'_>, estimate: Estimate) -> Fit {
    let weights = Weights::new(problem, &estimate);
    evaluate_weighted(problem, estimate, weights)
}

/// Evaluates an estimate under given weights.
#[must_use]
pub fn evaluate_weighted(problem: Problem<'_>, estimate: Estimate, weights: Weights) -> Fit {
    let residuals = residuals(problem, &weights, &estimate);
    let cost = square_sum(&huber(residuals.clone())) + estimate.prior_cost();
    Fit {
        estimate,
        weights,
        residuals,
        cost,
    }
}

/// Fits all free parameters from `start`, coarse to fine.
#[must_use]
pub fn fit(problem: Problem<'_>, start: Estimate) -> Fit {
    let weights = Weights::new(problem, &start);
    let start = coarse_descent(problem, &weights, start);
    refine(problem, start)
}

/// Descends with the coarse weights, which emphasise flow and angle.
fn coarse_descent(problem: Problem<'_>, weights: &Weights, start: Estimate) -> Estimate {
    let (coarse, moves) = (weights.clone().scaled(COARSE), Moves::All);
    descend(problem, &coarse, start, moves, COARSE_ITERATIONS).estimate
}

/// A short fit under given weights that decides whether an effect deserves a full fit.
#[must_use]
pub fn short_fit(problem: Problem<'_>, weights: &Weights, start: Estimate) -> Descent {
    descend(problem, weights, start, Moves::All, COARSE_ITERATIONS)
}

/// Fits from a start near the optimum.
#[must_use]
pub fn refine(problem: Problem<'_>, start: Estimate) -> Fit {
    let found = |weights: &Weights, start: Estimate| {
        let start = synchronised(problem, weights, start);
        let moves = Moves::All;
        descend(problem, weights, start, moves, FINE_ITERATIONS).estimate
    };
    let weights = Weights::new(problem, &start);
    let near = found(&weights, start);
    // The weights depend on the values: repeat with the weights at the values found.
    let weights = Weights::new(problem, &near);
    let there = found(&weights, near);
    evaluate_weighted(problem, there, weights)
}

/// A few iterations under given weights from a start that has almost converged. Sizes of switching effects stay fixed:
/// a step that improves a few runs slightly moves the switching instants of all others.
#[must_use]
pub fn refine_once(problem: Problem<'_>, weights: &Weights, start: Estimate) -> Estimate {
    let moves = Moves::AllButSwitching;
    descend(problem, weights, start, moves, LAST_ITERATIONS).estimate
}

/// Fits only each run's load error under given weights, by two Gauss-Newton steps: the problem is nearly linear.
#[must_use]
pub fn fit_loads(problem: Problem<'_>, weights: &Weights, start: Estimate) -> Estimate {
    let mut estimate = start;
    for _ in 0..2 {
        let steps = load_steps(problem, weights, &estimate);
        for (run, step) in steps.into_iter().enumerate() {
            estimate.set_load(run, estimate.load(run) + step);
        }
    }
    estimate
}
