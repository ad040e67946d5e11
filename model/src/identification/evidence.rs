//! How much the data say, with autocorrelated residuals counted at their effective number.
//!
//! Part of the noise of real instruments is slow, and what is left of a missing effect is slower still; counted as
//! independent samples such residuals make nine false alarms in ten. The variance of a signature's amplitude is
//! therefore taken from the autocovariances of residual and signature together (Newey & West 1987, Bartlett window),
//! for each effect on its own: a signature that changes quickly is hurt less than one that drifts.

use rayon::prelude::*;

use super::experiment::Experiment;
use super::jacobian::square_sum;

/// Reach of the autocovariances, s.
const REACH_S: f64 = 2.0;

/// By how much autocorrelation inflates the variance of the amplitude of `signature` in `residuals`; one for white
/// residuals.
#[must_use]
pub fn variance_inflation(
    experiment: &Experiment,
    residuals: &[Vec<f64>],
    signature: &[Vec<f64>],
) -> f64 {
    let sums: Vec<(f64, f64)> = (0..residuals.len())
        .into_par_iter()
        .map(|run| {
            let time_s = &experiment.runs[run].drive.time_s;
            let samples = time_s.len();
            let step_s = (time_s[samples - 1] - time_s[0]) / (samples - 1) as f64;
            let reach = ((REACH_S / step_s) as usize).clamp(1, samples / 2);
            let mut sums = (0.0, 0.0);
            for channel in 0..4 {
                let part = channel * samples..(channel + 1) * samples;
                let (long, short) =
                    windowed(&residuals[run][part.clone()], &signature[run][part], reach);
                sums.0 += long;
                sums.1 += short;
            }
            sums
        })
        .collect();
    let (long, short) = sums
        .iter()
        .fold((0.0, 0.0), |(l, s), (long, short)| (l + long, s + short));
    if short > 0.0 {
        (long / short).max(1.0)
    } else {
        1.0
    }
}

/// Bartlett-windowed sum of products of autocovariances, and its term without lag.
fn windowed(residual: &[f64], signature: &[f64], reach: usize) -> (f64, f64) {
    if signature.iter().all(|&value| value == 0.0) {
        return (0.0, 0.0);
    }
    let samples = residual.len() as f64;
    let covariance = |series: &[f64], lag: usize| -> f64 {
        series[lag..]
            .iter()
            .zip(series)
            .map(|(a, b)| a * b)
            .sum::<f64>()
            / samples
    };
    let at_zero = covariance(residual, 0) * covariance(signature, 0) * samples;
    let lagged: f64 = (1..=reach)
        .map(|lag| {
            let weight = 1.0 - lag as f64 / (reach + 1) as f64;
            2.0 * weight * covariance(residual, lag) * covariance(signature, lag) * samples
        })
        .sum();
    (at_zero + lagged, at_zero)
}

/// Root mean square of a signature over the compared samples, in sigmas.
#[must_use]
pub fn detectability(signature: &[Vec<f64>], compared: usize) -> f64 {
    (square_sum(signature) / compared as f64).sqrt()
}

/// Logarithm of the odds that an effect with one more parameter is there: the fall of the cost, in effective units,
/// less Schwarz's price of a parameter.
#[must_use]
pub fn log_odds(likelihood_ratio: f64, parameters: usize, effective_samples: f64) -> f64 {
    0.5 * likelihood_ratio - 0.5 * parameters as f64 * effective_samples.max(2.0).ln()
}

/// Shares that add up to one from logarithms of odds.
#[must_use]
pub fn shares(log_odds: &[f64]) -> Vec<f64> {
    let largest = log_odds.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let odds: Vec<f64> = log_odds.iter().map(|l| (l - largest).exp()).collect();
    let total: f64 = odds.iter().sum();
    odds.iter().map(|o| o / total).collect()
}
