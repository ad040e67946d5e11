//! Channels that follow the currents after a dead time.
//!
//! When a current falls after it was constant, flow, pump pressure and speed of the angle fall. Lags of spools and sensors begin
//! at once, linearly or as a parabola; a dead time moves the beginning. Of a parabola, four times the deviation is at twice the
//! time: `2 t1 - t4` is zero for it, negative for a first-order lag, and the dead time for a shifted step.

use std::ops::Range;

use hitch_campaign::Run;
use hitch_plant::Channel;

use crate::finding::{Evidence, Finding, Kind};
use crate::logs::{FAR, Logs, Open, currents};
use crate::statistics::{median, spread_about};

/// Least dead time that is named, s: 0.15 that buses and filters may have, and 0.1 in which the current falls below the valve's threshold.
const NAMED_S: f64 = 0.25;
/// Fewest closings.
const FEWEST: usize = 4;
/// Longest ramp of a current that falls, s.
const RAMP_S: f64 = 0.3;
/// Time of constant current before a closing, s, and the one whose median is the level before it.
const BEFORE_S: f64 = 0.4;
const LEVEL_S: f64 = 0.2;
/// Longest time after a closing that is searched, s.
const AFTER_S: f64 = 3.0;
/// First deviation, as a share of the whole fall; also that of the angle's first deviation in sigma.
const SHARE: f64 = 0.1;

/// The channels with a dead time.
pub(crate) fn findings(logs: &Logs) -> Vec<Finding> {
    let channels = [Channel::PumpPressure, Channel::Flow, Channel::RockerAngle];
    channels
        .into_iter()
        .filter_map(|channel| of_channel(logs, channel))
        .collect()
}

fn of_channel(logs: &Logs, channel: Channel) -> Option<Finding> {
    let mut times = Vec::new();
    for (at, run) in logs.runs().iter().enumerate() {
        let Some(values) = run.channel(channel) else {
            continue;
        };
        for closing in closings(logs, at, channel) {
            let sigma = logs.noise_of(channel);
            let level = logs.samples(at, LEVEL_S);
            times.extend(match channel {
                Channel::RockerAngle => stop_s(run, values, &closing, level, sigma),
                _ => fall_s(run, values, &closing, level, sigma),
            });
        }
    }
    let dead_s = median(times.iter().copied());
    let step_s = 1.0 / logs.campaign.sample_rate_hz;
    if times.len() < FEWEST || dead_s < NAMED_S.max(3.0 * step_s) {
        return None;
    }
    // The valve shuts somewhere in the ramp of its current.
    let spread_s = spread_about(times.iter().copied(), dead_s);
    let accuracy_s = spread_s.max(2.0 * step_s) + RAMP_S / 3.0;
    let seen = format!(
        "The {} follows the currents {dead_s:.2} s late, by {} closings of a valve.",
        channel.title(),
        times.len()
    );
    let cure = "Synchronise the clocks of the loggers, or shift the channel by this time.";
    Some(
        Finding::new(
            Kind::Delay,
            Evidence::new(dead_s, accuracy_s, "s"),
            seen,
            cure,
        )
        .of(channel.key()),
    )
}

/// The samples from which a current falls, to the next opening or the end. The pump pressure depends on the lift valve only.
fn closings(logs: &Logs, at: usize, channel: Channel) -> Vec<Range<usize>> {
    let run = &logs.runs()[at];
    let [before, ramp, after] = [BEFORE_S, RAMP_S, AFTER_S].map(|s| logs.samples(at, s));
    let count = run.time_s.len();
    let valves = match channel {
        Channel::PumpPressure => &[Open::Lift][..],
        _ => &[Open::Lift, Open::Lower],
    };
    let falls = |i: &usize| {
        let open = logs.open(at, i - 1);
        let valve = usize::from(open == Open::Lower);
        let current = currents(run)[valve];
        valves.contains(&open)
            && current[i - 1] - current[*i] > FAR * logs.current_noise_a[valve]
            && logs.currents_constant(at, i - before..*i)
            && (i + ramp..i + ramp + 4).all(|k| logs.open(at, k) == Open::Neither)
    };
    let until = |i: usize| {
        let next = (i + ramp..count).find(|&k| logs.open(at, k) != Open::Neither);
        i..next.unwrap_or(count).min(i + after)
    };
    let falling = (before..count.saturating_sub(ramp + 4)).filter(falls);
    falling.map(until).collect()
}

/// Dead time of a quantity that falls to its level at rest.
fn fall_s(
    run: &Run,
    values: &[f64],
    closing: &Range<usize>,
    level: usize,
    sigma: f64,
) -> Option<f64> {
    let i = closing.start;
    let before = median(values[i - level..i].iter().copied());
    let rest = &values[closing.end - (closing.len() / 3).max(2)..closing.end];
    let fall = before - median(rest.iter().copied());
    // A tenth of the fall has to be beyond noise.
    if SHARE * fall.abs() < 0.5 * FAR * sigma {
        return None;
    }
    let fallen = |share: f64| {
        let beyond = |k: usize| (before - values[k]) / fall > share;
        first(closing, beyond).map(|k| run.time_s[k] - run.time_s[i])
    };
    Some(2.0 * fallen(SHARE)? - fallen(4.0 * SHARE)?)
}

/// Dead time of an angle that moves and stops.
fn stop_s(
    run: &Run,
    values: &[f64],
    closing: &Range<usize>,
    level: usize,
    sigma: f64,
) -> Option<f64> {
    let i = closing.start;
    let half = |range: Range<usize>| median(values[range].iter().copied());
    let (early, late) = (half(i - 2 * level..i - level), half(i - level..i));
    let step_s = (run.time_s[i - 1] - run.time_s[i - 2 * level]) / (2 * level - 1) as f64;
    let speed = (late - early) / (level as f64 * step_s);
    let middle_s = run.time_s[i - 1] - 0.5 * (level - 1) as f64 * step_s;
    // The noise of the extrapolation is that of the level's samples.
    let least = 1.5 * FAR * sigma;
    let passing_s = least / speed.abs();
    if passing_s > 0.2 * NAMED_S {
        return None;
    }
    let behind = |times: f64| {
        let beyond = |k: usize| {
            let extrapolated = late + speed * (run.time_s[k] - middle_s);
            (extrapolated - values[k]) * speed.signum() > times * least
        };
        first(closing, beyond).map(|k| run.time_s[k] - run.time_s[i])
    };
    Some(2.0 * behind(1.0)? - behind(4.0)? + 2.0 * passing_s)
}

/// The first of two consecutive samples for which a condition holds.
fn first(range: &Range<usize>, holds: impl Fn(usize) -> bool) -> Option<usize> {
    (range.start..range.end - 1).find(|&k| holds(k) && holds(k + 1))
}
