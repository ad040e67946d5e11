//! Evidence of effects, with autocorrelated residuals counted at their effective sample size.
//!
//! Part of the noise of real instruments is slow, and the residuals of a missing effect are slower still. Counted as
//! independent samples, such residuals cause nine false alarms in ten. The variance of a signature's amplitude is
//! therefore computed from the autocovariances of residual and signature together (Newey & West 1987, Bartlett window),
//! for each effect separately: autocorrelation affects a fast signature less than a slowly varying one.

use crate::data::experiment::Experiment;
use crate::data::ready_run::ReadyRun;
use crate::estimation::residual_columns::{dot, square_sum};
use crate::parallel;

/// Window length of the autocovariances, s.
const REACH_S: f64 = 2.0;

/// Factor by which autocorrelation increases the variance of the amplitude of `signature` in `residuals`; one for white
/// residuals.
#[must_use]
pub fn variance_inflation(
    experiment: &Experiment,
    residuals: &[Vec<f64>],
    signature: &[Vec<f64>],
) -> f64 {
    let sums: Vec<(f64, f64)> = parallel::map(0..residuals.len(), |run| {
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
    });
    let (long, short) = sums
        .iter()
        .fold((0.0, 0.0), |(l, s), (long, short)| (l + long, s + short));
    if short > 0.0 {
        (long / short).max(1.0)
    } else {
        1.0
    }
}

/// Window length of the autocovariances in a run, samples.
fn reach(run: &ReadyRun) -> usize {
    let (samples, time_s) = (run.len(), &run.drive.time_s);
    let step_s = (time_s[samples - 1] - time_s[0]) / (samples - 1) as f64;
    ((REACH_S / step_s) as usize).clamp(1, samples / 2)
}

/// Autocovariance of a series of zero mean at a lag, in samples.
fn covariance(series: &[f64], lag: usize) -> f64 {
    dot(&series[lag..], &series[..series.len() - lag]) / series.len() as f64
}

/// Weight of a lag in a Bartlett window.
fn bartlett(lag: usize, reach: usize) -> f64 {
    1.0 - lag as f64 / (reach + 1) as f64
}

/// Bartlett-windowed sum of products of autocovariances, and its term at lag zero.
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

/// Expected [`variance_inflation`] of a signature in a planned experiment whose noise has the given autocorrelation.
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

/// Root mean square of a signature over the compared samples, in sigmas; `penalty` is the prior cost of its projected
/// part.
#[must_use]
pub fn detectability(signature: &[Vec<f64>], penalty: f64, compared: usize) -> f64 {
    ((square_sum(signature) + penalty) / compared as f64).sqrt()
}

/// Log-odds that an effect with `parameters` parameters is present: half the likelihood ratio less Schwarz's penalty.
#[must_use]
pub fn log_odds(likelihood_ratio: f64, parameters: usize, effective_samples: f64) -> f64 {
    0.5 * likelihood_ratio - 0.5 * parameters as f64 * effective_samples.max(2.0).ln()
}

/// Probabilities that add up to one, from log-odds.
#[must_use]
pub fn shares(log_odds: &[f64]) -> Vec<f64> {
    let largest = log_odds.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let odds: Vec<f64> = log_odds.iter().map(|l| (l - largest).exp()).collect();
    let total: f64 = odds.iter().sum();
    odds.iter().map(|o| o / total).collect()
}

/// Smallest accepted likelihood ratio of an effect: chi-squared with one degree of freedom at 5 %, corrected for some
/// fifty tests.
pub const SIGNIFICANT: f64 = 11.0;

/// Likelihood ratio above which two alternatives are distinguishable.
pub const DISTINGUISHABLE: f64 = 10.0;

/// Smallest accepted detectability, in sigma. Clock offsets of a few milliseconds, a logger's rounding and the
/// discretisation of the plant cause signatures of up to 0.05 on steady and 0.09 on ringing campaigns without hidden
/// effects.
pub(crate) const VISIBLE: f64 = 0.1;
