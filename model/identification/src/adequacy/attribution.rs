//! Signals on which the remaining error depends.

use crate::adequacy::signal::Signal;
use crate::data::experiment::Experiment;
use crate::estimation::fit::Fit;

/// Number of bins per signal.
const BINS: usize = 12;

/// The remaining error, and the signals it depends on.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Attribution {
    /// Remaining share of the squared error in excess of noise, 0 to 1.
    pub share: f64,
    /// Signals, by decreasing correlation ratio.
    pub depends_on: Vec<Signal>,
}

/// Ranks signals by the share of the variance of the squared residuals that their bins explain.
#[must_use]
pub fn attribute(experiment: &Experiment, before: &Fit, after: &Fit) -> Attribution {
    let excess = |fit: &Fit| (fit.error().powi(2) - 1.0).max(0.0);
    let share = if excess(before) > 0.0 {
        (excess(after) / excess(before)).min(1.0)
    } else {
        0.0
    };
    let squares = squares_by_sample(experiment, after);
    let mut ranked: Vec<(f64, Signal)> = Signal::ALL
        .map(|signal| {
            (
                correlation_ratio(&signal.samples(experiment), &squares),
                signal,
            )
        })
        .to_vec();
    ranked.sort_by(|a, b| b.0.total_cmp(&a.0));
    let best = ranked.first().map_or(0.0, |(ratio, _)| *ratio);
    Attribution {
        share,
        depends_on: ranked
            .into_iter()
            .filter(|(ratio, _)| *ratio > 0.25 * best && *ratio > 0.0)
            .map(|(_, signal)| signal)
            .collect(),
    }
}

/// Sum of squared residuals over the channels at each sample, capped to limit the influence of single edges.
fn squares_by_sample(experiment: &Experiment, fit: &Fit) -> Vec<f64> {
    const CAP: f64 = 100.0;
    let mut squares = Vec::new();
    for (run, residual) in experiment.runs.iter().zip(&fit.residuals) {
        for sample in 0..run.len() {
            let sum: f64 = (0..4)
                .map(|c| residual[c * run.len() + sample].powi(2))
                .sum();
            squares.push(sum.min(CAP));
        }
    }
    squares
}

/// Share of the variance of `y` between the bins of `x` (square of Pearson's correlation ratio).
fn correlation_ratio(x: &[f64], y: &[f64]) -> f64 {
    let known = || x.iter().zip(y).filter(|(x, _)| x.is_finite());
    let (low, high) = known().fold(
        (f64::INFINITY, f64::NEG_INFINITY),
        |(low, high), (&x, _)| (low.min(x), high.max(x)),
    );
    if high <= low {
        return 0.0;
    }
    let mut bins = [(0.0, 0.0); BINS];
    let (mut count, mut sum, mut square) = (0.0, 0.0, 0.0);
    for (&x, &y) in known() {
        let bin = (((x - low) / (high - low) * BINS as f64) as usize).min(BINS - 1);
        bins[bin].0 += 1.0;
        bins[bin].1 += y;
        count += 1.0;
        sum += y;
        square += y * y;
    }
    let total = square - sum * sum / count;
    let between: f64 = bins
        .iter()
        .filter(|b| b.0 > 0.0)
        .map(|b| b.1 * b.1 / b.0)
        .sum::<f64>()
        - sum * sum / count;
    if total > 0.0 { between / total } else { 0.0 }
}
