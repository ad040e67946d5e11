//! Lack-of-fit test: whether the residuals are noise, judged by the worst cell.
//!
//! A cell is a channel in a regime at a load. An error that is small on average can be large in one cell. A correct fit
//! leaves every cell's mean square near one; a wrong or incomplete one does not.

use std::collections::BTreeMap;

use hitch_campaign::Bench;
use hitch_plant::Channel;

use crate::data::experiment::Experiment;
use crate::data::regime::Regime;
use crate::estimation::fit::Fit;

/// Fewest samples of a cell.
const FEWEST: usize = 30;

/// A mean square above this is not noise, however small its standard error.
const TOLERATED: f64 = 1.35;

/// The same for a ringing pressure: single oscillations after a switch are only as accurate as the constants of the
/// stop, the seal and the hose.
const TOLERATED_RINGING: f64 = 4.0;

/// The same for the discrepancy of an adopted model beside a baseline: it is one error over a whole cell, and the largest
/// of some dozen may have three times its size.
pub(crate) const TOLERATED_DISCREPANCY: f64 = 9.0;

/// Relative accuracy with which an effect of the right form reproduces a change of the channels: tables, areas and
/// loads are accurate to half a percent, and the instant of ground contact to one sample.
pub(crate) const EXACT: f64 = 0.03;

/// Relative accuracy of the valves' flow tables, and thus of any model based on them: 0.1 in 60 l/min, which a hundred
/// samples of a flow bench would resolve.
const TABLES: f64 = 0.002;

/// Standard errors by which the largest of some hundred mean squares may exceed one.
const DEVIATIONS: f64 = 6.0;

/// Factor by which slow noise increases the variance of a mean square: a fifth of the noise variance with a correlation
/// time of 0.4 s gives 1.8.
pub(crate) const SLOW_NOISE: f64 = 2.0;

/// One cell of the residuals.
#[derive(Debug, Clone, PartialEq)]
pub struct Cell {
    /// Channel.
    pub channel: Channel,
    /// Regime of the plant.
    pub regime: Regime,
    /// Hitch or flow bench, with its load or port pressure.
    pub bench: Bench,
    /// Compared samples.
    pub samples: usize,
    /// Mean of the whitened residuals.
    pub mean: f64,
    /// Mean square of the whitened residuals.
    pub mean_square: f64,
    /// Tolerated mean square, independent of its standard error.
    pub tolerated: f64,
    /// Mean square that the error of the flow tables may add to that of noise.
    pub of_tables: f64,
}

impl Cell {
    /// Largest mean square that is compatible with noise.
    #[must_use]
    pub fn limit(&self) -> f64 {
        limit(self.samples, self.tolerated) + self.of_tables
    }

    /// Excess of the mean square over one relative to the limit's; a value above one is lack of fit.
    #[must_use]
    pub fn excess(&self) -> f64 {
        (self.mean_square - 1.0) / (self.limit() - 1.0)
    }
}

/// Channel, regime, and kind and level of the bench.
type CellKey = (usize, Regime, u8, i64);

/// Sums over the samples of a cell.
#[derive(Clone, Copy)]
struct Sums {
    bench: Bench,
    samples: usize,
    residual: f64,
    square: f64,
    /// Squared readings in units of the noise.
    reading: f64,
    /// Share of the variance that is a discrepancy.
    discrepancy: f64,
}

/// Tolerated mean square of a channel, by its index.
fn tolerated(experiment: &Experiment, channel: usize) -> f64 {
    let pressure = matches!(
        Channel::ALL[channel],
        Channel::PumpPressure | Channel::CylinderPressure
    );
    if experiment.ringing && pressure {
        TOLERATED_RINGING
    } else {
        TOLERATED
    }
}

/// Largest mean square of this many samples that is compatible with noise.
fn limit(samples: usize, tolerated: f64) -> f64 {
    let scatter = (2.0 * SLOW_NOISE / samples as f64).sqrt();
    (1.0 + DEVIATIONS * scatter).max(tolerated)
}

/// The cells of a fit after effects were added. Where the fit without them had larger residuals (`before`), the
/// tolerance grows accordingly, as an effect explains a change only to a relative accuracy. The error of the effect is
/// independent of the others that are tolerated, so their squares add.
#[must_use]
pub fn cells_since(before: &[Cell], experiment: &Experiment, fit: &Fit) -> Vec<Cell> {
    let mut cells = cells(experiment, fit);
    for cell in &mut cells {
        let same = |other: &&Cell| {
            (other.channel, other.regime, other.bench) == (cell.channel, cell.regime, cell.bench)
        };
        let had = before
            .iter()
            .find(same)
            .map_or(1.0, |other| other.mean_square);
        cell.tolerated += EXACT * EXACT * (had - 1.0).max(0.0);
    }
    sort(&mut cells);
    cells
}

/// Sorts by decreasing excess.
fn sort(cells: &mut [Cell]) {
    cells.sort_by(|a, b| b.excess().total_cmp(&a.excess()));
}

/// All cells of a fit that have enough samples, by decreasing excess. Samples in states that a baseline does not show are
/// in none: how well the model describes them is unknown.
#[must_use]
pub fn cells(experiment: &Experiment, fit: &Fit) -> Vec<Cell> {
    let mut sums: BTreeMap<CellKey, Sums> = BTreeMap::new();
    let whitened = fit.residuals.iter().zip(&fit.weights.runs);
    for (run, (residual, weights)) in experiment.runs.iter().zip(whitened) {
        let (kind, level) = match run.bench {
            Bench::Hitch { load_kg } => (0, load_kg.round() as i64),
            Bench::Flow { port_pressure_bar } => (1, port_pressure_bar.round() as i64),
        };
        for channel in 0..4 {
            for sample in 0..run.len() {
                let at = channel * run.len() + sample;
                if let Some(discrepancy) = run.discrepancy(at)
                    && weights.scale[at] > 0.0
                {
                    let key = (channel, run.regimes[sample], kind, level);
                    let sum = sums.entry(key).or_insert(Sums {
                        bench: run.bench,
                        samples: 0,
                        residual: 0.0,
                        square: 0.0,
                        reading: 0.0,
                        discrepancy: 0.0,
                    });
                    let reading = run.measured[channel]
                        .as_ref()
                        .map_or(0.0, |all| all[sample]);
                    sum.samples += 1;
                    sum.residual += residual[at];
                    sum.square += residual[at] * residual[at];
                    sum.reading += (reading * weights.scale[at]).powi(2);
                    sum.discrepancy += discrepancy;
                }
            }
        }
    }
    let mut cells: Vec<Cell> = sums
        .into_iter()
        .filter(|(_, sums)| sums.samples >= FEWEST)
        .map(|((channel, regime, _, _), sums)| {
            let samples = sums.samples as f64;
            Cell {
                channel: Channel::ALL[channel],
                regime,
                bench: sums.bench,
                samples: sums.samples,
                mean: sums.residual / samples,
                mean_square: sums.square / samples,
                tolerated: tolerated(experiment, channel)
                    .max(1.0 + (TOLERATED_DISCREPANCY - 1.0) * sums.discrepancy / samples),
                of_tables: match Channel::ALL[channel] {
                    Channel::Flow => TABLES * TABLES * sums.reading / samples,
                    _ => 0.0,
                },
            }
        })
        .collect();
    sort(&mut cells);
    cells
}

/// Whether every cell, and every channel as a whole, is compatible with noise: many cells with too few samples can
/// still add up.
#[must_use]
pub fn adequate(experiment: &Experiment, cells: &[Cell], fit: &Fit) -> bool {
    let cells_are_noise = cells.first().is_none_or(|worst| worst.excess() <= 1.0);
    let channels_are_noise = (0..4).all(|channel| {
        let samples = fit.weights.counts[channel];
        samples == 0
            || fit.channel_error(channel).powi(2) <= limit(samples, tolerated(experiment, channel))
    });
    cells_are_noise && channels_are_noise
}
