//! How much the data say, with autocorrelated residuals counted at their effective number.
//!
//! Part of the noise of real instruments is slow, and what is left of a missing effect is slower still; counted as
//! independent samples such residuals make nine false alarms in ten. The variance of a signature's amplitude is
//! therefore taken from the autocovariances of residual and signature together (Newey & West 1987, Bartlett window),
//! for each effect on its own: a signature that changes quickly is hurt less than one that drifts.

use rayon::prelude::*;

use crate::data::experiment::{Experiment, ReadyRun};
use crate::estimation::jacobian::{dot, square_sum};

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
            let (samples, reach) = (experiment.runs[run].len(), reach(&experiment.runs[run]));
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

/// Reach of the autocovariances in a run, samples.
fn reach(run: &ReadyRun) -> usize {
    let (samples, time_s) = (run.len(), &run.drive.time_s);
    let step_s = (time_s[samples - 1] - time_s[0]) / (samples - 1) as f64;
    ((REACH_S / step_s) as usize).clamp(1, samples / 2)
}

/// Mean product of a series with itself `lag` samples later.
fn covariance(series: &[f64], lag: usize) -> f64 {
    dot(&series[lag..], &series[..series.len() - lag]) / series.len() as f64
}

/// Weight of a lag in a Bartlett window.
fn bartlett(lag: usize, reach: usize) -> f64 {
    1.0 - lag as f64 / (reach + 1) as f64
}

/// Bartlett-windowed sum of products of autocovariances, and its term without lag.
fn windowed(residual: &[f64], signature: &[f64], reach: usize) -> (f64, f64) {
    if signature.iter().all(|&value| value == 0.0) {
        return (0.0, 0.0);
    }
    let samples = residual.len() as f64;
    let at_zero = covariance(residual, 0) * covariance(signature, 0) * samples;
    let lagged: f64 = (1..=reach)
        .map(|lag| {
            2.0 * bartlett(lag, reach)
                * covariance(residual, lag)
                * covariance(signature, lag)
                * samples
        })
        .sum();
    (at_zero + lagged, at_zero)
}

/// Autocorrelation of residuals over all runs, by channel and then by lag, in samples; empty for a channel without any.
#[must_use]
pub fn persistence(experiment: &Experiment, residuals: &[Vec<f64>]) -> [Vec<f64>; 4] {
    std::array::from_fn(|channel| {
        let parts = experiment
            .runs
            .iter()
            .zip(residuals)
            .map(|(run, residual)| {
                let samples = run.len();
                (
                    &residual[channel * samples..(channel + 1) * samples],
                    reach(run),
                )
            });
        let mut sums: Vec<f64> = Vec::new();
        for (part, reach) in parts {
            sums.resize(sums.len().max(reach + 1), 0.0);
            for (lag, sum) in sums.iter_mut().enumerate().take(reach + 1) {
                *sum += covariance(part, lag) * part.len() as f64;
            }
        }
        let square = sums.first().copied().unwrap_or(0.0);
        if square > 0.0 {
            sums.iter().map(|sum| sum / square).collect()
        } else {
            Vec::new()
        }
    })
}

/// [`variance_inflation`] that a signature will meet in runs yet to be measured, whose noise is as persistent as that
/// of runs which were.
#[must_use]
pub fn expected_inflation(
    experiment: &Experiment,
    persistence: &[Vec<f64>; 4],
    signature: &[Vec<f64>],
) -> f64 {
    let (mut long, mut short) = (0.0, 0.0);
    for (run, signature) in experiment.runs.iter().zip(signature) {
        let (samples, reach) = (run.len(), reach(run));
        for (channel, correlation) in persistence.iter().enumerate() {
            let part = &signature[channel * samples..(channel + 1) * samples];
            let at_zero = covariance(part, 0) * samples as f64;
            short += at_zero;
            long += at_zero;
            for (lag, rho) in correlation.iter().enumerate().take(reach + 1).skip(1) {
                let weight = 2.0 * bartlett(lag, reach) * rho;
                long += weight * covariance(part, lag) * samples as f64;
            }
        }
    }
    if short > 0.0 {
        (long / short).max(1.0)
    } else {
        1.0
    }
}

/// Root mean square of a signature over the compared samples, in sigmas; `penalty` is what imitating it costs in priors.
#[must_use]
pub fn detectability(signature: &[Vec<f64>], penalty: f64, compared: usize) -> f64 {
    ((square_sum(signature) + penalty) / compared as f64).sqrt()
}

/// Logarithm of the odds that an effect with one more parameter is there: the fall of the cost, in effective units,
/// less Schwarz's penalty of a parameter.
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

/// Likelihood ratio that an effect needs: chi-squared with one degree of freedom at 5 % over some fifty tries.
pub const BELIEVED: f64 = 11.0;

/// Likelihood ratio by which an alternative has to be worse to be told apart.
pub const TOLD_APART: f64 = 10.0;

/// Smallest detectability that is believed, sigmas. Channels a few milliseconds out of step, a logger's rounding and
/// the plant's discretisation make signatures of up to 0.05 on steady and 0.09 on ringing campaigns with nothing
/// hidden.
pub(crate) const VISIBLE: f64 = 0.1;
