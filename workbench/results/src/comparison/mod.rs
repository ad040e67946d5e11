//! Comparison of a model with measurements by condition, time and channel, in units of the instruments' noise.
mod cell;
mod change;
mod current_groups;
mod evaluated;
mod groups;
mod raw_error;
mod show;
mod tally;
mod worst;

use hitch_campaign::Campaign;
use hitch_identification::estimation::fit::ErrorSums;
use hitch_measurement::{Finding, check};
use hitch_plant::{Channel, Model};
use schemars::JsonSchema;
use serde::Serialize;

pub use cell::Cell;
pub use change::{Change, ChangedStretch, changes, largest_change_in_part};
pub use current_groups::CurrentGroups;
pub use evaluated::Evaluated;
pub use groups::Grouping;
pub use raw_error::{RawError, raw_errors};
pub use worst::{WorstStretch, worst_by_part, worst_in_part};

/// Result of `hitch compare`.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Comparison {
    /// Name of the campaign.
    pub campaign: String,
    /// Name of the model.
    pub model: String,
    /// Faults of the measurement that the logs alone show; a model may be wrong where they are.
    pub measurement: Vec<Finding>,
    /// Root mean square of (measured - simulated) / noise, each channel weighted alike.
    pub error: f64,
    /// Error of a perfect model.
    pub noise_floor: f64,
    /// One entry for each measured channel.
    pub channels: Vec<ChannelError>,
    /// Every cell of every grouping that has samples.
    pub cells: Vec<Cell>,
    /// The worst stretch of each channel.
    pub worst: Vec<WorstStretch>,
}

/// Error of one channel.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ChannelError {
    /// Key of the channel.
    pub channel: &'static str,
    /// Unit of the values.
    pub unit: &'static str,
    /// Weighted error: root mean square in sigma.
    pub error: f64,
    /// Unweighted error: root mean square of measured - simulated, in the unit.
    pub rms: f64,
    /// One sigma of the instrument, in the unit.
    pub noise: f64,
    /// Compared samples.
    pub samples: usize,
}

impl Comparison {
    /// Compares a model with a campaign.
    pub fn new(campaign: &Campaign, model: &Model) -> (Self, Evaluated) {
        let evaluated = Evaluated::new(campaign, model);
        let comparison = Self {
            measurement: check(campaign, Some(model)),
            ..Self::of(&evaluated, model)
        };
        (comparison, evaluated)
    }

    /// The comparison of an evaluated model, without its logs: no fault of the measurement is sought.
    pub fn of(evaluated: &Evaluated, model: &Model) -> Self {
        let sums = ErrorSums::of(&evaluated.fit);
        Self {
            campaign: evaluated.experiment.name.clone(),
            model: model.name.clone(),
            measurement: Vec::new(),
            error: sums.error(),
            noise_floor: 1.0,
            channels: channels(evaluated, model, &sums),
            cells: evaluated.cells(),
            worst: Channel::ALL
                .into_iter()
                .filter_map(|channel| worst::worst(evaluated, channel))
                .collect(),
        }
    }
}

fn channels(evaluated: &Evaluated, model: &Model, sums: &ErrorSums) -> Vec<ChannelError> {
    let raw = raw_errors(&evaluated.experiment, &evaluated.fit, model);
    let of = |channel: Channel| {
        let RawError { rms, samples } = raw[channel.index()];
        (samples > 0).then(|| ChannelError {
            channel: channel.key(),
            unit: channel.unit(),
            error: sums.channel(channel.index()),
            rms,
            noise: evaluated.experiment.noise[channel.index()],
            samples,
        })
    };
    Channel::ALL.into_iter().filter_map(of).collect()
}
