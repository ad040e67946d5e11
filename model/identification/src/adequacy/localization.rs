//! Location of large residuals: along a signal, and by motion.

use hitch_plant::Channel;

use crate::adequacy::signal::Signal;
use crate::data::experiment::Experiment;
use crate::data::ready_run::ReadyRun;
use crate::estimation::fit::Fit;

/// Number of bins per signal.
const BINS: usize = 16;

/// Fewest samples of a bin.
const FEWEST: usize = 20;

/// Share of the worst bin's excess that a neighbouring bin needs to belong to the same stretch.
const STRETCH: f64 = 0.3;

/// Share of the excess that a motion needs to be named.
const MOSTLY: f64 = 0.6;

/// Share of the signal's range that counts as near its end.
const NEAR: f64 = 0.35;

/// Current from which a valve counts as driven, A.
const DRIVEN_A: f64 = 0.3;

/// Residuals of one channel in one bin of a signal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bin {
    /// Middle of the bin, in the signal's unit.
    pub centre: f64,
    /// Compared samples.
    pub samples: usize,
    /// Mean of the whitened residuals.
    pub mean: f64,
    /// Their standard deviation.
    pub deviation: f64,
}

/// Residuals of the worst channel along a signal.
#[derive(Debug, Clone, PartialEq)]
pub struct ErrorProfile {
    /// The signal.
    pub signal: Signal,
    /// The channel.
    pub channel: Channel,
    /// Bins with enough samples, in the order of the signal.
    pub bins: Vec<Bin>,
    /// Range of the signal in which the residuals are large, in its unit.
    pub stretch: (f64, f64),
    /// The motion to which most of the squared residuals in the stretch belong.
    pub motion: Option<&'static str>,
    /// The end of the travel near which the stretch lies.
    pub end: Option<&'static str>,
}

impl ErrorProfile {
    /// Profile along a signal; `None` if the campaign has too few samples of it.
    #[must_use]
    pub fn new(experiment: &Experiment, fit: &Fit, signal: Signal) -> Option<Self> {
        let compared = Channel::ALL
            .into_iter()
            .filter(|c| fit.weights.counts[c.index()] > 0);
        let by_error = |a: &Channel, b: &Channel| {
            let error = |channel: &Channel| fit.channel_error(channel.index());
            error(a).total_cmp(&error(b))
        };
        let channel = compared.max_by(by_error)?;
        let samples = samples(experiment, fit, signal, channel);
        let bins = bins(&samples);
        let (low, high) = stretch(&bins)?;
        let (least, greatest) = (bins[0].centre, bins[bins.len() - 1].centre);
        let near = NEAR * (greatest - least);
        let end = match signal {
            Signal::RockerAngle if high < least + near => Some("near the bottom"),
            Signal::RockerAngle if low > greatest - near => Some("near the top"),
            _ => None,
        };
        Some(Self {
            signal,
            channel,
            motion: motion(&samples, low, high),
            stretch: (low, high),
            bins,
            end,
        })
    }
}

impl std::fmt::Display for ErrorProfile {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (low, high) = self.stretch;
        let digits = usize::from(high - low < 10.0);
        write!(f, "{} {low:.digits$} to {high:.digits$}", self.signal)?;
        match (self.end, self.motion) {
            (None, None) => Ok(()),
            (Some(end), Some(motion)) => write!(f, ", {end} while {motion}"),
            (Some(word), None) | (None, Some(word)) => write!(f, ", {word}"),
        }
    }
}

/// A compared sample: value of the signal, whitened residual, motion.
type Sample = (f64, f64, &'static str);

fn samples(experiment: &Experiment, fit: &Fit, signal: Signal, channel: Channel) -> Vec<Sample> {
    let values = signal.samples(experiment);
    let mut samples = Vec::new();
    let mut first = 0;
    for (index, run) in experiment.runs.iter().enumerate() {
        let offset = channel.index() * run.len();
        for sample in 0..run.len() {
            let value = values[first + sample];
            if fit.weights.runs[index].scale[offset + sample] > 0.0 && value.is_finite() {
                let residual = fit.residuals[index][offset + sample];
                samples.push((value, residual, motion_of(run, sample)));
            }
        }
        first += run.len();
    }
    samples
}

fn motion_of(run: &ReadyRun, sample: usize) -> &'static str {
    let current = run.drive.currents[sample];
    if current.lower_a > DRIVEN_A.max(current.lift_a) {
        "lowering"
    } else if current.lift_a > DRIVEN_A {
        "lifting"
    } else {
        "holding"
    }
}

fn bins(samples: &[Sample]) -> Vec<Bin> {
    let values = || samples.iter().map(|sample| sample.0);
    let low = values().fold(f64::INFINITY, f64::min);
    let width = (values().fold(f64::NEG_INFINITY, f64::max) - low) / BINS as f64;
    let mut sums = [(0_usize, 0.0, 0.0); BINS];
    if width.is_nan() || width <= 0.0 {
        return Vec::new();
    }
    for (value, residual, _) in samples {
        let bin = &mut sums[(((value - low) / width) as usize).min(BINS - 1)];
        *bin = (bin.0 + 1, bin.1 + residual, bin.2 + residual * residual);
    }
    let filled = sums.iter().enumerate().filter(|(_, sum)| sum.0 >= FEWEST);
    filled
        .map(|(index, &(samples, sum, square))| {
            let mean = sum / samples as f64;
            Bin {
                centre: low + (index as f64 + 0.5) * width,
                samples,
                mean,
                deviation: (square / samples as f64 - mean * mean).max(0.0).sqrt(),
            }
        })
        .collect()
}

/// Ends of the stretch around the worst bin; `None` without bins.
fn stretch(bins: &[Bin]) -> Option<(f64, f64)> {
    let excess = |bin: &Bin| bin.mean.powi(2) + bin.deviation.powi(2) - 1.0;
    let worst = (0..bins.len()).max_by(|&a, &b| excess(&bins[a]).total_cmp(&excess(&bins[b])))?;
    let belongs = |bin: &&Bin| excess(bin) > STRETCH * excess(&bins[worst]);
    let after = bins[worst..].iter().take_while(belongs).count();
    let before = bins[..worst].iter().rev().take_while(belongs).count();
    let half = 0.5 * (bins[bins.len() - 1].centre - bins[0].centre) / (BINS - 1) as f64;
    let last = (worst + after).saturating_sub(1).max(worst);
    Some((bins[worst - before].centre - half, bins[last].centre + half))
}

/// The motion to which most of the squared residuals between two values of the signal belong.
fn motion(samples: &[Sample], low: f64, high: f64) -> Option<&'static str> {
    let inside = || samples.iter().filter(|s| (low..=high).contains(&s.0));
    let energy = |wanted: Option<&str>| -> f64 {
        let chosen = inside().filter(|s| wanted.is_none_or(|wanted| s.2 == wanted));
        chosen.map(|s| s.1 * s.1 - 1.0).sum::<f64>().max(0.0)
    };
    let all = energy(None);
    let mut motions = ["lifting", "lowering", "holding"].into_iter();
    motions.find(|motion| all > 0.0 && energy(Some(motion)) > MOSTLY * all)
}
