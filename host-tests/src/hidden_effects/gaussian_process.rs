//! A Gaussian process for the discrepancy (Kennedy & O'Hagan 2001): it corrects the model without naming an effect.
//!
//! Exact, with a squared-exponential kernel over the known signals of a sample: currents, their rates, simulated
//! pressure, flow and angle, oil temperature. Its data are a few hundred samples of the training runs; length and
//! variance come from the marginal likelihood over a grid.

use hitch_campaign::{Bench, Campaign};
use hitch_identification::data::experiment::Experiment;
use hitch_identification::data::ready_run::ReadyRun;
use hitch_plant::simulation::Trace;
use hitch_plant::{Channel, Model};
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use super::answer::{Abilities, Answer, Method};
use super::residuals::{Comparison, ErrorSums};

/// Samples that a process is trained on.
const TRAINED_ON: usize = 300;

/// Parts that the runs are dealt into, each held out once, as the project's own identification does.
const FOLDS: usize = 4;

/// Length scales that are tried, in deviations of the inputs.
const LENGTHS: [f64; 5] = [0.3, 0.6, 1.2, 2.5, 5.0];

/// Signal variances that are tried, in variances of the residual.
const VARIANCES: [f64; 3] = [0.3, 1.0, 3.0];

/// Inputs of a sample.
const INPUTS: usize = 8;
type Input = [f64; INPUTS];

/// Discrepancy by a Gaussian process.
#[derive(Debug)]
pub struct GaussianProcess;

impl Method for GaussianProcess {
    fn name(&self) -> &'static str {
        "Gaussian process"
    }

    fn abilities(&self) -> Abilities {
        Abilities {
            names: false,
            unknown: false,
            intervals: false,
        }
    }

    fn answer(&self, campaign: &Campaign, model: &Model) -> Answer {
        let experiment = Experiment::new(campaign, model);
        let comparison = Comparison::new(&experiment, model);
        let traces = comparison.traces(&[]);
        let inputs: Vec<Vec<Input>> = experiment
            .runs
            .iter()
            .zip(&traces)
            .map(|(run, trace)| inputs(run, trace))
            .collect();
        let scales = scales(&inputs);
        let inputs: Vec<Vec<Input>> = inputs
            .into_iter()
            .map(|run| {
                run.into_iter()
                    .map(|input| scaled(&input, &scales))
                    .collect()
            })
            .collect();
        let (mut before, mut after) = (ErrorSums::default(), ErrorSums::default());
        for channel in Channel::ALL {
            let residuals: Vec<Vec<f64>> = (0..traces.len())
                .map(|run| comparison.filtered(run, channel, &traces[run]))
                .collect();
            for fold in 0..FOLDS.min(traces.len()) {
                let process = Process::train(&inputs, &residuals, |run| run % FOLDS != fold);
                for run in (0..traces.len()).filter(|run| run % FOLDS == fold) {
                    before.add(channel, residuals[run].iter().copied());
                    let left = inputs[run]
                        .iter()
                        .zip(&residuals[run])
                        .map(|(input, residual)| residual - process.mean(input));
                    after.add(channel, left);
                }
            }
        }
        Answer {
            held_out: Some((before.error(), after.error())),
            ..Answer::default()
        }
    }
}

/// The known signals at each sample of a run.
fn inputs(run: &ReadyRun, trace: &Trace) -> Vec<Input> {
    let time_s = &run.drive.time_s;
    (0..run.len())
        .map(|sample| {
            let here = run.drive.currents[sample];
            let before = run.drive.currents[sample.saturating_sub(5)];
            let over_s = time_s[sample] - time_s[sample.saturating_sub(5)] + 1e-9;
            let on_hitch = matches!(run.bench, Bench::Hitch { .. });
            let angle_deg = if on_hitch {
                trace.channel(Channel::RockerAngle)[sample]
            } else {
                0.0
            };
            [
                here.lift_a,
                here.lower_a,
                (here.lift_a - before.lift_a) / over_s,
                (here.lower_a - before.lower_a) / over_s,
                trace.channel(Channel::CylinderPressure)[sample],
                trace.channel(Channel::Flow)[sample],
                angle_deg,
                run.oil_temperature_c,
            ]
        })
        .collect()
}

/// Mean and deviation of every input.
fn scales(inputs: &[Vec<Input>]) -> [(f64, f64); INPUTS] {
    let count = inputs.iter().map(Vec::len).sum::<usize>() as f64;
    std::array::from_fn(|k| {
        let values = || inputs.iter().flatten().map(move |input| input[k]);
        let mean = values().sum::<f64>() / count;
        let variance = values().map(|value| (value - mean).powi(2)).sum::<f64>() / count;
        (mean, variance.sqrt().max(1e-9))
    })
}

fn scaled(input: &Input, scales: &[(f64, f64); INPUTS]) -> Input {
    std::array::from_fn(|k| (input[k] - scales[k].0) / scales[k].1)
}

/// A trained process.
struct Process {
    at: Vec<Input>,
    weights: DVector<f64>,
    length: f64,
    variance: f64,
}

impl Process {
    fn train(
        inputs: &[Vec<Input>],
        residuals: &[Vec<f64>],
        in_training: impl Fn(usize) -> bool,
    ) -> Self {
        let samples: Vec<(Input, f64)> = (0..inputs.len())
            .filter(|&run| in_training(run))
            .flat_map(|run| {
                inputs[run]
                    .iter()
                    .copied()
                    .zip(residuals[run].iter().copied())
            })
            .filter(|(_, residual)| residual.is_finite())
            .collect();
        let stride = (samples.len() / TRAINED_ON).max(1);
        let (at, values): (Vec<Input>, Vec<f64>) =
            samples.into_iter().skip(stride / 2).step_by(stride).unzip();
        let values = DVector::from_vec(values);
        let spread = values.norm_squared() / values.len().max(1) as f64;
        let mut best = (f64::NEG_INFINITY, Self::nothing());
        for length in LENGTHS {
            for relative in VARIANCES {
                let variance = relative * spread;
                let Some(factor) = covariance(&at, length, variance).cholesky() else {
                    continue;
                };
                let weights = factor.solve(&values);
                let evidence = evidence(&factor, &values, &weights);
                if evidence > best.0 {
                    let process = Self {
                        at: at.clone(),
                        weights,
                        length,
                        variance,
                    };
                    best = (evidence, process);
                }
            }
        }
        best.1
    }

    fn nothing() -> Self {
        Self {
            at: Vec::new(),
            weights: DVector::zeros(0),
            length: 1.0,
            variance: 0.0,
        }
    }

    fn mean(&self, input: &Input) -> f64 {
        self.at
            .iter()
            .zip(self.weights.iter())
            .map(|(at, weight)| weight * kernel(at, input, self.length, self.variance))
            .sum()
    }
}

fn kernel(a: &Input, b: &Input, length: f64, variance: f64) -> f64 {
    let square: f64 = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum();
    variance * (-0.5 * square / (length * length)).exp()
}

/// Covariance of the training values; their noise is one by whitening.
fn covariance(at: &[Input], length: f64, variance: f64) -> DMatrix<f64> {
    DMatrix::from_fn(at.len(), at.len(), |row, column| {
        let noise = if row == column { 1.0 } else { 0.0 };
        kernel(&at[row], &at[column], length, variance) + noise
    })
}

/// Logarithm of the marginal likelihood but for a constant.
fn evidence(factor: &Cholesky<f64, Dyn>, values: &DVector<f64>, weights: &DVector<f64>) -> f64 {
    let log_determinant: f64 = factor.l_dirty().diagonal().iter().map(|d| d.ln()).sum();
    -0.5 * values.dot(weights) - log_determinant
}
