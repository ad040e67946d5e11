//! What the logs of a campaign show about its measurement: arithmetic alone, before any physics is named.
//!
//! [`check`] returns a [`Finding`] for each fault: its kind, run, channel and time, its size, and its cure. Every threshold follows
//! from the noise of a channel, the count of samples, or the physics.
//!
//! From the bottom layer to the top: robust statistics; the finding; the logs with their noise and the stretches in which a valve
//! is open; the checks, one kind a file.
#![forbid(unsafe_code)]

mod current_zero;
mod dead_pressure;
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
use hitch_plant::Model;

use crate::logs::Logs;

/// Faults of the measurement of a campaign. With a model, loads and units follow from its weight at rest; without, from the other runs.
#[must_use]
pub fn check(campaign: &Campaign, model: Option<&Model>) -> Vec<Finding> {
    let logs = Logs::new(campaign, model);
    let checks = [
        current_zero::findings,
        direction::flow,
        direction::angle,
        no_motion::findings,
        repeated_run::findings,
        delay::findings,
        logger::temperature,
        logger::ripple,
        logger::interval,
        logger::resolution,
    ];
    let equal = equal_samples::findings(&logs);
    let spikes = spikes::findings(&logs, &equal);
    let pressures = pressures(&logs);
    let others = checks.iter().flat_map(|findings| findings(&logs));
    pressures
        .into_iter()
        .chain(equal)
        .chain(spikes)
        .chain(others)
        .collect()
}

/// Faults of the pressures. One that explains another comes first: exchanged sensors, a dead one, a unit, a load.
fn pressures(logs: &Logs) -> Vec<Finding> {
    let below = pump_below_cylinder::findings(logs);
    let exchanged = below.iter().any(|finding| finding.run.is_none());
    if exchanged {
        return below;
    }
    let mut found = dead_pressure::findings(logs);
    found.extend(pressure_unit::findings(logs));
    let known = |finding: &Finding| found.iter().any(|other| other.run == finding.run);
    let below: Vec<Finding> = below
        .into_iter()
        .filter(|finding| !known(finding))
        .collect();
    found.extend(below);
    let loads = load::findings(logs, &found);
    found.extend(loads);
    found
}
