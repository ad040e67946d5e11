//! What the logs of a campaign show about its measurement: arithmetic alone, before any physics is named.
//!
//! [`check`] returns a [`Finding`] for each fault: its kind, run, channel and time, its size, and its correction. A threshold
//! follows from the noise of a channel, the count of samples or the physics where its comment derives it; the others are choices.
//!
//! From the bottom layer to the top: robust statistics; the finding; the logs with their noise and the stretches in which a valve
//! is open; the checks, one kind a file.
#![forbid(unsafe_code)]

mod current_zero;
mod delay;
mod direction;
mod equal_samples;
mod finding;
mod lifting;
mod load;
mod logger;
mod logs;
mod no_motion;
mod pressure_unit;
mod pump_below_cylinder;
mod repeated_run;
mod rest_pressure;
mod spikes;
mod statistics;

pub use finding::{Evidence, Finding, Kind};

use hitch_campaign::Campaign;
use hitch_plant::{Channel, Model};

use crate::finding::unexplained;
use crate::logs::Logs;

/// Faults of the measurement of a campaign. With a model, loads and units follow from its weight at rest; without, from the other runs.
#[must_use]
pub fn check(campaign: &Campaign, model: Option<&Model>) -> Vec<Finding> {
    let logs = Logs::new(campaign, model);
    let mut found = equal_samples::findings(&logs);
    found.extend(spikes::findings(&logs, &found));
    found.extend(pressures(&logs, &found));
    let others = [
        current_zero::findings,
        direction::findings,
        no_motion::findings,
        repeated_run::findings,
        delay::findings,
        logger::findings,
    ];
    found.extend(others.iter().flat_map(|findings| findings(&logs)));
    found
}

/// Faults of the pressures. One that explains another comes first: a range, exchanged sensors, a unit or a dead sensor, a load.
fn pressures(logs: &Logs, equal: &[Finding]) -> Vec<Finding> {
    let key = Some(Channel::CylinderPressure.key());
    let below = pump_below_cylinder::findings(logs);
    let is_range = |finding: &Finding| finding.kind == Kind::Saturated && finding.channel == key;
    let exchanged = below.iter().any(|finding| finding.run.is_none());
    if exchanged || equal.iter().any(is_range) {
        return below;
    }
    let mut found = pressure_unit::findings(logs);
    found.extend(unexplained(below, &found));
    found.extend(load::findings(logs, &found));
    found
}
