//! Unweighted error of a model: measured minus simulated, in the units of the channels.

use hitch_identification::data::experiment::Experiment;
use hitch_identification::estimation::fit::Fit;
use hitch_plant::simulation::Trace;
use hitch_plant::{Channel, Model};

use super::tally::Tally;

/// Unweighted error of a channel over all runs.
#[derive(Debug, Clone, Copy)]
pub struct RawError {
    /// Root mean square of measured - simulated, in the channel's unit; NaN without samples. An angle that drifts from the
    /// measured one counts in full, whereas the error in sigma weights the drift by the accuracy with which a simulation
    /// can follow it.
    pub rms: f64,
    /// Compared samples.
    pub samples: usize,
}

/// Unweighted errors by [`Channel::index`].
pub fn raw_errors(experiment: &Experiment, fit: &Fit, model: &Model) -> [RawError; 4] {
    let mut tallies = [Tally::default(); 4];
    for run in 0..experiment.runs.len() {
        let trace = simulated(experiment, fit, model, run);
        for channel in Channel::ALL {
            let differences = differences(experiment, fit, run, channel, &trace);
            let tally = &mut tallies[channel.index()];
            differences.for_each(|difference| tally.add(difference));
        }
    }
    tallies.map(|tally| RawError {
        rms: tally.rms(),
        samples: tally.samples,
    })
}

/// Simulated samples of every channel of a run, in the channels' units.
pub fn simulated(experiment: &Experiment, fit: &Fit, model: &Model, run: usize) -> Trace {
    let nuisance = fit.estimate.nuisances[run];
    let model = fit.estimate.applied_to(model);
    experiment.runs[run].simulate(&model, nuisance, &fit.estimate.clocks)
}

/// Measured minus simulated for the compared samples of a channel of a run, in the channel's unit.
fn differences<'e>(
    experiment: &'e Experiment,
    fit: &'e Fit,
    run: usize,
    channel: Channel,
    trace: &'e Trace,
) -> impl Iterator<Item = f64> + 'e {
    let measured = experiment.runs[run].measured[channel.index()]
        .as_deref()
        .unwrap_or_default();
    let scale = &fit.weights.runs[run].scale;
    let scale = scale.iter().skip(channel.index() * measured.len());
    let pairs = measured.iter().zip(trace.channel(channel)).zip(scale);
    pairs
        .filter(|(_, scale)| **scale > 0.0)
        .map(|((measured, simulated), _)| measured - simulated)
}
