//! Whether what a model leaves is noise, judged by its worst cell.
//!
//! A cell is a channel in a regime at a load. An error that is small on the whole can be large in one corner; a
//! correct fit leaves every cell's mean square near one, a wrong or incomplete one does not.

use std::collections::BTreeMap;

use hitch_campaign::Bench;
use hitch_plant::Channel;

use crate::data::experiment::Experiment;
use crate::data::regime::Regime;
use crate::estimation::fit::Fit;

/// Fewest samples that make a cell.
const FEWEST: usize = 30;

/// A mean square above this is not noise, however small the cell's scatter.
const TOLERATED: f64 = 1.35;

/// A ringing pressure may be off by this much more: single swings after a switch are as good as the stop, the seal and
/// the hose that they ring against are known.
const TOLERATED_RINGING: f64 = 4.0;

/// An effect of the right form changes what a model shows to within this share of the change: the tables, areas and loads
/// that it works with are good to half a percent, and when a hitch comes down on the ground to within a sample.
const EXACT: f64 = 0.03;

/// The valves' tables are good to this share of a flow, and so is no model that is made of them any better: a tenth of a
/// litre in sixty, which a bench's hundred samples would show.
const TABLES: f64 = 0.002;

/// Standard deviations that the largest of some hundred cells may lie above one.
const DEVIATIONS: f64 = 6.0;

/// By how much slow noise spreads a mean square: a fifth of the variance with a correlation time of 0.4 s gives 1.8.
pub(crate) const SLOW_NOISE: f64 = 2.0;

/// One cell of the residuals.
#[derive(Debug, Clone, PartialEq)]
pub struct Cell {
    /// Channel.
    pub channel: Channel,
    /// What the plant was doing.
    pub regime: Regime,
    /// Hitch or flow bench, with its load or port pressure.
    pub bench: Bench,
    /// Compared samples.
    pub samples: usize,
    /// Mean of the whitened residuals.
    pub mean: f64,
    /// Mean square of the whitened residuals.
    pub mean_square: f64,
    /// Mean square that is borne with however small the cell's scatter is.
    pub tolerated: f64,
    /// Mean square that the tables' own error may add to noise.
    pub of_tables: f64,
}

impl Cell {
    /// Mean square that noise alone would hardly exceed.
    #[must_use]
    pub fn limit(&self) -> f64 {
        limit(self.samples, self.tolerated) + self.of_tables
    }

    /// How far the cell is beyond what noise explains; above one it is not noise.
    #[must_use]
    pub fn excess(&self) -> f64 {
        (self.mean_square - 1.0) / (self.limit() - 1.0)
    }
}

/// Channel, regime, and kind and level of the bench.
type Key = (usize, Regime, u8, i64);

/// Bench, number of samples, and the sums of their residuals, of the squares, and of the squares of the readings over the
/// noise.
type Sums = (Bench, usize, f64, f64, f64);

/// Mean square of a channel, by its index, that is borne with.
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

/// Mean square of a number of samples that noise alone would hardly exceed.
fn limit(samples: usize, tolerated: f64) -> f64 {
    let scatter = (2.0 * SLOW_NOISE / samples as f64).sqrt();
    (1.0 + DEVIATIONS * scatter).max(tolerated)
}

/// The cells of a fit to which effects were added, where the model without them had others: what the effects explain
/// there they need not explain to the last bit.
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
        cell.tolerated = cell.tolerated.max(1.0 + EXACT * EXACT * (had - 1.0));
    }
    sort(&mut cells);
    cells
}

/// The worst first.
fn sort(cells: &mut [Cell]) {
    cells.sort_by(|a, b| b.excess().total_cmp(&a.excess()));
}

/// All cells of a fit that have enough samples, worst first.
#[must_use]
pub fn cells(experiment: &Experiment, fit: &Fit) -> Vec<Cell> {
    let mut sums: BTreeMap<Key, Sums> = BTreeMap::new();
    let whitened = fit.residuals.iter().zip(&fit.weights.runs);
    for (run, (residual, weights)) in experiment.runs.iter().zip(whitened) {
        let (kind, level) = match run.bench {
            Bench::Hitch { load_kg } => (0, load_kg.round() as i64),
            Bench::Flow { port_pressure_bar } => (1, port_pressure_bar.round() as i64),
        };
        for channel in 0..4 {
            for sample in 0..run.len() {
                let at = channel * run.len() + sample;
                if weights.scale[at] > 0.0 {
                    let key = (channel, run.regimes[sample], kind, level);
                    let sum = sums.entry(key).or_insert((run.bench, 0, 0.0, 0.0, 0.0));
                    let reading = run.measured[channel]
                        .as_ref()
                        .map_or(0.0, |all| all[sample]);
                    sum.1 += 1;
                    sum.2 += residual[at];
                    sum.3 += residual[at] * residual[at];
                    sum.4 += (reading * weights.scale[at]).powi(2);
                }
            }
        }
    }
    let mut cells: Vec<Cell> = sums
        .into_iter()
        .filter(|(_, sums)| sums.1 >= FEWEST)
        .map(
            |((channel, regime, _, _), (bench, samples, sum, square, readings))| Cell {
                channel: Channel::ALL[channel],
                regime,
                bench,
                samples,
                mean: sum / samples as f64,
                mean_square: square / samples as f64,
                tolerated: tolerated(experiment, channel),
                of_tables: match Channel::ALL[channel] {
                    Channel::Flow => TABLES * TABLES * readings / samples as f64,
                    _ => 0.0,
                },
            },
        )
        .collect();
    sort(&mut cells);
    cells
}

/// Whether every cell is noise, and every channel as a whole: many cells too small to judge can still add up.
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
