//! What replaces parts of a shown run, or of the error map, while a parameter is set by hand or a candidate is looked at.

use std::sync::Arc;

use hitch_identification::data::problem::Problem;
use hitch_identification::data::ready_run::ReadyRun;
use hitch_identification::estimate::Estimate;
use hitch_identification::estimation::fit::evaluate_weighted;
use hitch_plant::{AddedEffect, Channel};
use schemars::JsonSchema;
use serde::Serialize;

use crate::session::{Ranking, Step};
use crate::source::Subject;
use hitch_results::comparison::{Cell, Evaluated};
use hitch_results::report::map_view::MeasuredChannel;
use hitch_results::web::plot::{Samples, SimulatedChannel};

/// Parts of the measured channels of a run.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(rename = "{C}s")]
pub struct RunParts<C> {
    /// Index of the run.
    pub run: usize,
    /// A part of each channel.
    pub channels: Vec<C>,
}

/// The part of the residuals of a channel that a candidate explains.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Signature {
    /// Residual without it minus residual with it, sigma.
    pub signature: Samples,
}

/// Errors of all runs with a parameter set by hand, sigma.
#[derive(Debug, Serialize, JsonSchema)]
pub struct TriedRuns {
    /// Of all channels.
    pub error: f64,
    /// By channel.
    pub channels: Vec<MeasuredChannel>,
    /// By run.
    pub runs: Samples,
    /// By cell.
    pub cells: Vec<Cell>,
}

impl RunParts<SimulatedChannel<Samples>> {
    /// A run simulated with manually set parameters; `None` if there is no such run.
    pub fn preview(
        subject: &Subject,
        step: &Step,
        estimate: &Estimate,
        run: usize,
    ) -> Option<Self> {
        let ready = subject.experiment().runs.get(run)?;
        let weights = &step.evaluated.fit.weights.runs[run];
        let model = estimate.applied_to(&subject.model);
        let trace = ready.simulate(&model, estimate.nuisances[run], &estimate.clocks);
        let residuals = weights.whiten(ready, &trace);
        let channel = |channel: Channel| {
            let part = channel.index() * ready.len()..(channel.index() + 1) * ready.len();
            let compared = residuals[part.clone()].iter().zip(&weights.scale[part]);
            let residual: Vec<f64> = compared
                .map(|(residual, &scale)| if scale > 0.0 { *residual } else { f64::NAN })
                .collect();
            let seen = residual.iter().filter(|residual| residual.is_finite());
            let square: f64 = seen.clone().map(|residual| residual * residual).sum();
            SimulatedChannel {
                simulated: Samples::of(trace.channel(channel)),
                error: (square / seen.count() as f64).sqrt(),
                residual: Samples(residual),
            }
        };
        Some(Self::of(run, ready, channel))
    }
}

impl RunParts<Signature> {
    /// The part of a run's residuals that a candidate explains at its fitted size. `None` if the run or candidate does not
    /// exist.
    pub fn signature(
        subject: &Subject,
        step: &Step,
        ranking: &Ranking,
        effect: &str,
        run: usize,
    ) -> Option<Self> {
        let ready = subject.experiment().runs.get(run)?;
        let candidate = ranking.candidate(effect)?;
        let fit = &step.evaluated.fit;
        let mut estimate = fit.estimate.clone();
        estimate.effects.push(AddedEffect {
            effect: candidate.effect,
            values: candidate.values().to_vec(),
        });
        let model = estimate.applied_to(&subject.model);
        let trace = ready.simulate(&model, fit.estimate.nuisances[run], &fit.estimate.clocks);
        let with = fit.weights.runs[run].whiten(ready, &trace);
        let channel = |channel: Channel| {
            let with = &with[channel.index() * ready.len()..];
            let without = step.evaluated.residuals(run, channel);
            let explained = without.iter().zip(with).map(|(a, b)| a - b);
            Signature {
                signature: Samples(explained.collect()),
            }
        };
        Some(Self::of(run, ready, channel))
    }
}

impl<C> RunParts<C> {
    /// A part of each measured channel.
    fn of(run: usize, ready: &ReadyRun, part: impl Fn(Channel) -> C) -> Self {
        let is_measured = |channel: &Channel| ready.measured[channel.index()].is_some();
        let channels = Channel::ALL.into_iter().filter(is_measured);
        Self {
            run,
            channels: channels.map(part).collect(),
        }
    }
}

impl TriedRuns {
    /// The errors of all runs with manually set parameters, with the weights of the step.
    pub fn of(subject: &Subject, step: &Step, estimate: Estimate) -> Self {
        let (experiment, model) = (subject.experiment(), &subject.model);
        let weights = step.evaluated.fit.weights.clone();
        let fit = evaluate_weighted(Problem::new(experiment, model), estimate, weights);
        let evaluated = Evaluated::fitted(Arc::clone(&step.evaluated.experiment), fit, model);
        let runs = 0..experiment.runs.len();
        Self {
            error: evaluated.fit.error(),
            channels: MeasuredChannel::all(&evaluated),
            runs: Samples(runs.map(|run| evaluated.run_error(run)).collect()),
            cells: evaluated.cells(),
        }
    }
}
