//! A model evaluated on a campaign.

use hitch_plant::simulation::Trace;

use super::cell::Cell;
use super::current_groups::CurrentGroups;
use super::groups::Part;
use super::raw_error;
use super::tally::{Tally, add_to};
use crate::comparison::Grouping;
use hitch_campaign::Campaign;
use hitch_identification::data::experiment::Experiment;
use hitch_identification::data::problem::Problem;
use hitch_identification::estimation::fit::Fit;
use hitch_identification::explanation::explain::fit_base;
use hitch_plant::{Channel, Model};
use std::sync::Arc;

/// A model evaluated on a campaign.
#[derive(Debug, Clone)]
pub struct Evaluated {
    /// The prepared campaign.
    pub experiment: Arc<Experiment>,
    /// The model's simulation and residuals, each run's weighed load corrected within its tolerance.
    pub fit: Fit,
    /// Groups of the currents of the model's valves.
    pub groups: CurrentGroups,
}

impl Evaluated {
    /// Evaluates a model without changing it. The loads are estimated within the tolerance of their weighing, and the clock
    /// offsets within theirs, as before a search for effects: the error is the one that `explain` starts from.
    pub fn new(campaign: &Campaign, model: &Model) -> Self {
        Self::prepared(Experiment::new(campaign, model), model)
    }

    /// The same on a prepared campaign.
    pub fn prepared(experiment: Experiment, model: &Model) -> Self {
        let fit = fit_base(Problem::new(&experiment, model));
        Self::fitted(Arc::new(experiment), fit, model)
    }

    /// A fit of a model.
    pub fn fitted(experiment: Arc<Experiment>, fit: Fit, model: &Model) -> Self {
        Self {
            experiment,
            fit,
            groups: CurrentGroups::of(model),
        }
    }

    /// The same of a fit and a campaign that are kept.
    pub fn of(experiment: &Experiment, fit: &Fit, model: &Model) -> Self {
        Self::fitted(Arc::new(experiment.clone()), fit.clone(), model)
    }

    /// Whitened residuals of a channel of a run, NaN where not compared.
    pub fn residuals(&self, run: usize, channel: Channel) -> Vec<f64> {
        let samples = self.experiment.runs[run].len();
        let part = channel.index() * samples..(channel.index() + 1) * samples;
        let scale = &self.fit.weights.runs[run].scale[part.clone()];
        let value =
            |(residual, scale): (&f64, &f64)| if *scale > 0.0 { *residual } else { f64::NAN };
        self.fit.residuals[run][part]
            .iter()
            .zip(scale)
            .map(value)
            .collect()
    }

    /// Root mean square of the residuals of a channel of a run, in sigma.
    pub fn error(&self, run: usize, channel: Channel) -> f64 {
        let mut tally = Tally::default();
        self.residuals(run, channel)
            .into_iter()
            .for_each(|residual| tally.add(residual));
        tally.rms()
    }

    /// Every cell of every grouping that has samples.
    pub fn cells(&self) -> Vec<Cell> {
        let mut cells = Vec::new();
        for by in Grouping::ALL {
            for channel in Channel::ALL {
                let mut parts: Vec<(Part, Tally)> = Vec::new();
                for (index, run) in self.experiment.runs.iter().enumerate() {
                    let residuals = self.residuals(index, channel).into_iter().enumerate();
                    for (sample, residual) in residuals.filter(|(_, one)| one.is_finite()) {
                        if let Some(part) = by.part(&self.groups, run, sample) {
                            add_to(&mut parts, part, residual);
                        }
                    }
                }
                parts.sort_by(|a, b| a.0.partial_cmp(&b.0).unwrap_or(std::cmp::Ordering::Equal));
                cells.extend(parts.into_iter().map(|(part, tally)| Cell {
                    by,
                    part: part.name,
                    channel: channel.key(),
                    error: tally.rms(),
                    bias: tally.mean(),
                    samples: tally.samples,
                }));
            }
        }
        cells
    }

    /// Error of a run in sigma, each measured channel weighted alike; NaN if nothing of it is compared.
    pub fn run_error(&self, run: usize) -> f64 {
        let errors = Channel::ALL.map(|channel| self.error(run, channel));
        let compared = errors.into_iter().filter(|error| error.is_finite());
        let (squares, channels) = compared.fold((0.0, 0.0), |(squares, channels), error| {
            (squares + error * error, channels + 1.0)
        });
        f64::sqrt(squares / channels)
    }

    /// Simulated samples of every channel of a run, in the channels' units.
    pub fn simulated(&self, model: &Model, run: usize) -> Trace {
        raw_error::simulated(&self.experiment, &self.fit, model, run)
    }
}
