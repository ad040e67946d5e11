//! Channels that follow the currents after a dead time.
//!
//! When a current falls after it was constant, flow, pump pressure and speed of the angle fall. Lags of spools and sensors begin
//! at once, linearly or as a parabola; a dead time moves the beginning. Of a parabola, four times the deviation is at twice the
//! time: `2 t1 - t4` is zero for it, negative for a first-order lag, and the dead time for a shifted step.

use std::ops::Range;

use hitch_plant::Channel;

use crate::finding::{Evidence, Finding, Kind};
use crate::logs::{FAR, Logs, Open, currents};
use crate::statistics::{median, spread_about};

/// Least dead time that is named, s: 0.15 that buses and filters may have, and 0.1 in which the current falls below the valve's threshold.
const NAMED_S: f64 = 0.25;
/// Fewest closings: a quarter of wrong times does not bend their median.
const FEWEST: usize = 4;
/// Longest ramp of a current that falls, s.
const RAMP_S: f64 = 0.3;
/// Time whose median is the level before a closing, and over which the speed of the angle is taken, s.
const LEVEL_S: f64 = 0.2;
/// Longest time after a closing that is searched, s.
const AFTER_S: f64 = 3.0;
/// First deviation, as a share of the whole fall.
const SHARE: f64 = 0.1;

/// The channels with a dead time.
pub(crate) fn findings(logs: &Logs) -> Vec<Finding> {
    // The pump pressure depends on the lift valve only.
    let both = &[Open::Lift, Open::Lower][..];
    let channels = [
        (Channel::PumpPressure, &both[..1]),
        (Channel::Flow, both),
        (Channel::RockerAngle, both),
    ];
    let found = channels.map(|(channel, valves)| of_channel(logs, channel, valves));
    found.into_iter().flatten().collect()
}

fn of_channel(logs: &Logs, channel: Channel, valves: &[Open]) -> Option<Finding> {
    let runs = 0..logs.runs().len();
    let times = runs.flat_map(|run| dead_times_s(logs, run, channel, valves));
    let times: Vec<f64> = times.collect();
    let dead_s = median(times.iter().copied());
    let step_s = 1.0 / logs.campaign.sample_rate_hz;
    if times.len() < FEWEST || dead_s < NAMED_S.max(3.0 * step_s) {
        return None;
    }
    // The valve shuts somewhere in the ramp of its current.
    let spread_s = spread_about(times.iter().copied(), dead_s);
    let accuracy_s = spread_s.max(2.0 * step_s) + RAMP_S / 3.0;
    let (title, count) = (channel.title(), times.len());
    let seen = format!(
        "The {title} follows the currents {dead_s:.2} s late, by {count} closings of a valve."
    );
    let cure = "Synchronise the clocks of the loggers, or shift the channel by this time.";
    let evidence = Evidence::new(dead_s, accuracy_s, "s");
    Some(Finding::new(Kind::Delay, evidence, seen, cure).of(channel.key()))
}

/// The dead times of a channel of a run, one for each closing that it shows.
fn dead_times_s(logs: &Logs, run: usize, channel: Channel, valves: &[Open]) -> Vec<f64> {
    let Some(values) = logs.runs()[run].channel(channel) else {
        return Vec::new();
    };
    let level = logs.samples(run, LEVEL_S);
    let speed = |at: usize| values[at] - values[at.saturating_sub(level)];
    let (falling, sigma) = match channel {
        Channel::RockerAngle => ((0..values.len()).map(speed).collect(), 2f64.sqrt()),
        _ => (values.to_vec(), 1.0),
    };
    let far = 0.5 * FAR * sigma * logs.noise_of(channel);
    let closings = closings(logs, run, valves).into_iter();
    let samples = closings.filter_map(|closing| {
        let before = closing.start - level..closing.start;
        let before = median(falling[before].iter().copied());
        dead_samples(&falling, &closing, before, far)
    });
    samples
        .map(|samples| samples / logs.campaign.sample_rate_hz)
        .collect()
}

/// The samples from which a current falls that was constant, to the next opening or the end.
fn closings(logs: &Logs, at: usize, valves: &[Open]) -> Vec<Range<usize>> {
    let run = &logs.runs()[at];
    let [level, ramp, after] = [LEVEL_S, RAMP_S, AFTER_S].map(|s| logs.samples(at, s));
    let falls = |i: usize| {
        let open = logs.open(at, i - 1);
        let valve = usize::from(open == Open::Lower);
        let current = currents(run)[valve];
        valves.contains(&open)
            && current[i - 1] - current[i] > FAR * logs.current_noise_a[valve]
            && logs.currents_constant(at, i - 2 * level..i)
    };
    let rests = logs.stretches(at, Open::Neither).into_iter();
    let closing = |rest: Range<usize>| {
        let from = rest.start.saturating_sub(ramp).max(2 * level);
        let begin = (from..rest.start + 1).find(|&i| falls(i))?;
        let end = rest.end.min(rest.start + after);
        (rest.len() > ramp).then_some(begin..end)
    };
    rests.filter_map(closing).collect()
}

/// Dead time, samples, of a quantity that falls to its level at rest, if a tenth of the fall is far beyond noise.
fn dead_samples(values: &[f64], closing: &Range<usize>, before: f64, far: f64) -> Option<f64> {
    let rest = closing.end - closing.len() / 3..closing.end;
    let fall = before - median(values[rest].iter().copied());
    let fallen = |share: f64| {
        let beyond = |k: usize| (before - values[k]) / fall > share;
        let mut pairs = closing.clone().zip(closing.start + 1..closing.end);
        let first = pairs.position(|(a, b)| beyond(a) && beyond(b))?;
        Some(first as f64)
    };
    (SHARE * fall.abs() >= far).then_some(2.0 * fallen(SHARE)? - fallen(4.0 * SHARE)?)
}
