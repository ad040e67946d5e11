//! Signals on which the remaining error depends.

use hitch_campaign::Bench;
use hitch_plant::Channel;

use crate::data::experiment::Experiment;
use crate::estimation::fit::Fit;

/// Number of bins per signal.
const BINS: usize = 12;

/// The remaining error, and the signals it depends on.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Attribution {
    /// Remaining share of the squared error in excess of noise, 0 to 1.
    pub share: f64,
    /// Names of signals, by decreasing correlation ratio.
    pub depends_on: Vec<String>,
}

/// Names of the signals that are examined.
const SIGNALS: [&str; 8] = [
    "rocker_angle_deg",
    "cylinder_pressure_bar",
    "flow_lpm",
    "lift_current_a",
    "lower_current_a",
    "load_kg",
    "oil_temperature_c",
    "time_s",
];

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
    let mut ranked: Vec<(f64, &str)> = SIGNALS
        .iter()
        .filter_map(|&name| {
            let values = signal_values(experiment, name)?;
            Some((correlation_ratio(&values, &squares), name))
        })
        .collect();
    ranked.sort_by(|a, b| b.0.total_cmp(&a.0));
    let best = ranked.first().map_or(0.0, |(ratio, _)| *ratio);
    Attribution {
        share,
        depends_on: ranked
            .into_iter()
            .filter(|(ratio, _)| *ratio > 0.25 * best && *ratio > 0.0)
            .map(|(_, name)| name.to_owned())
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

/// A signal, by its name, at every sample of every run; `None` for an unknown name.
pub(crate) fn signal_values(experiment: &Experiment, name: &str) -> Option<Vec<f64>> {
    let signal = SIGNALS.iter().position(|&signal| signal == name)?;
    let mut values = Vec::new();
    for run in &experiment.runs {
        let measured = |channel: Channel, sample: usize| {
            run.measured[channel.index()]
                .as_ref()
                .map_or(f64::NAN, |v| v[sample])
        };
        for sample in 0..run.len() {
            values.push(match signal {
                0 => measured(Channel::RockerAngle, sample),
                1 => measured(Channel::CylinderPressure, sample),
                2 => measured(Channel::Flow, sample),
                3 => run.drive.currents[sample].lift_a,
                4 => run.drive.currents[sample].lower_a,
                5 => match run.bench {
                    Bench::Hitch { load_kg } => load_kg,
                    Bench::Flow { .. } => f64::NAN,
                },
                6 => run.oil_temperature_c,
                _ => run.drive.time_s[sample],
            });
        }
    }
    Some(values)
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
