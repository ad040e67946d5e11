//! Single samples far off neighbours that agree with each other.

use hitch_plant::Channel;

use crate::finding::{Evidence, Finding, Kind};
use crate::logs::{FAR, Logs, SETTLING_S};
use crate::statistics::{median, noise};

/// Deviation of a spike in sigma: three times what noise reaches, as pressures dip when a valve moves.
const SPIKE: f64 = 3.0 * FAR;
/// Neighbours on either side.
const SIDE: usize = 3;

/// The spikes of each channel of each run, except of channels whose samples are equal in stretches: they jump at their ends.
pub(crate) fn findings(logs: &Logs, equal: &[Finding]) -> Vec<Finding> {
    let jumps = |channel: &Channel| equal.iter().any(|of| of.channel == Some(channel.key()));
    let channels = Channel::ALL.into_iter().filter(|channel| !jumps(channel));
    let of_runs = |channel| {
        let runs = 0..logs.runs().len();
        runs.filter_map(move |run| of_channel(logs, run, channel))
    };
    channels.flat_map(of_runs).collect()
}

fn of_channel(logs: &Logs, at: usize, channel: Channel) -> Option<Finding> {
    let run = &logs.runs()[at];
    let values = run.channel(channel)?;
    // Chatter of a valve, or another unit, makes the noise of a single run larger.
    let sigma = logs.noise_of(channel).max(noise([values]));
    let settling = logs.samples(at, SETTLING_S);
    let spikes = (SIDE..values.len().saturating_sub(SIDE))
        .filter_map(|i| height(values, i, sigma).map(|height| (i, height)))
        .filter(|&(i, _)| logs.currents_constant(at, i.saturating_sub(settling)..i + SIDE + 1));
    let spikes: Vec<(usize, f64)> = spikes.collect();
    let (first, last) = (spikes.first()?.0, spikes.last()?.0);
    let higher = |a: f64, b: f64| if b.abs() > a.abs() { b } else { a };
    let largest = spikes.iter().map(|spike| spike.1).fold(0.0, higher);
    let (title, unit, count) = (channel.title(), channel.unit(), spikes.len());
    let seen = format!(
        "Single samples of the {title} lie off both sides at constant currents: {count}, by {largest:+.2} {unit} at most."
    );
    let cure = "Find the loose contact or the disturbance, and empty these cells in the log.";
    let evidence = Evidence::of(largest, 3.0 * sigma, channel);
    let finding = Finding::new(Kind::Spikes, evidence, seen, cure).in_run(logs.campaign, at);
    Some(
        finding
            .of(channel.key())
            .between(run.time_s[first], run.time_s[last]),
    )
}

/// Height of a spike over the line through its neighbours, which agree with it within noise; `None` without one.
fn height(values: &[f64], at: usize, sigma: f64) -> Option<f64> {
    let (before, after) = (&values[at - SIDE..at], &values[at + 1..=at + SIDE]);
    let middle = |side: &[f64]| median(side.iter().copied());
    let change = middle(after) - middle(before);
    let slope = change / (SIDE + 1) as f64;
    let line = |k: usize| 0.5 * (middle(after) + middle(before)) + slope * (k as f64 - at as f64);
    let around = (at - SIDE..=at + SIDE).filter(|k| *k != at);
    let off = around.map(|k| (values[k] - line(k)).abs());
    let known = before.iter().chain(after).all(|v| v.is_finite());
    let agree = known && off.fold(0.0, f64::max) < FAR * sigma;
    let height = values[at] - line(at);
    // At the corner of a motion that ends, the height is half the change.
    (agree && height.abs() > (SPIKE * sigma).max(change.abs())).then_some(height)
}
