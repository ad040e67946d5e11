//! Channels whose samples are equal for longer than their noise allows: at an extreme they are saturated.

use std::ops::Range;

use hitch_plant::Channel;

use crate::finding::{Evidence, Finding, Kind};
use crate::logs::{Logs, Open, extremes};
use crate::statistics::{longest_by_chance, noise, stretches};

/// Largest share of equal neighbours of a channel that shows its noise: above it, the resolution hides the noise, and equal samples say
/// nothing.
const MOST_EQUAL: f64 = 0.5;
/// Largest step in sigma at which no value in a step is constant.
const FINE: f64 = 0.6;
/// Fewest pairs of samples from which that share is known, within 5 %.
const FEWEST_PAIRS: usize = 100;

/// Time for which a logger or a resampling repeats the first or last value of a run, s.
const PADDED_S: f64 = 2.0;

/// A stretch of equal samples.
struct Equal {
    run: usize,
    value: f64,
    count: usize,
    from_s: f64,
    to_s: f64,
}

/// The channels with long stretches of equal samples.
pub(crate) fn findings(logs: &Logs) -> Vec<Finding> {
    Channel::ALL
        .into_iter()
        .flat_map(|channel| of_channel(logs, channel))
        .collect()
}

fn of_channel(logs: &Logs, channel: Channel) -> Vec<Finding> {
    let Some(fewest) = fewest_equal(logs, channel) else {
        return Vec::new();
    };
    let mut found: Vec<Equal> = Vec::new();
    let mut range = (f64::INFINITY, f64::NEG_INFINITY);
    for (at, run) in logs.runs().iter().enumerate() {
        let Some(values) = run.channel(channel) else {
            continue;
        };
        let (low, high) = extremes(values);
        range = (range.0.min(low), range.1.max(high));
        for stretch in equal_stretches(values, &run.time_s, fewest) {
            join(&mut found, Equal { run: at, ..stretch });
        }
    }
    report(logs, channel, &found, range)
}

/// As many equal samples in succession as chance does not give; `None` if the noise of the channel cannot be seen.
fn fewest_equal(logs: &Logs, channel: Channel) -> Option<usize> {
    let mut varied: Vec<Vec<f64>> = Vec::new();
    let mut samples = 0;
    for (at, run) in logs.runs().iter().enumerate() {
        let Some(values) = run.channel(channel) else {
            continue;
        };
        samples += values.len();
        for stretch in steady(logs, at, channel) {
            let known = values[stretch].iter().copied().filter(|v| v.is_finite());
            varied.push(known.collect());
        }
    }
    // A stretch whose samples are nearly all equal is what is looked for: it does not show the noise.
    varied.retain(|stretch| 4 * (stretch.len() - equal_pairs(stretch)) > stretch.len() + 4);
    let pairs: usize = varied.iter().map(|stretch| stretch.len() - 1).sum();
    let equal: usize = varied.iter().map(|stretch| equal_pairs(stretch)).sum();
    let share = equal as f64 / pairs.max(1) as f64;
    // Steps above the noise hide it in the middle of a step; values that alternate between two have 1.2 steps of noise at most.
    let fine = logs.step[channel.index()] < FINE * noise(varied.iter().map(Vec::as_slice));
    let shown = fine && pairs >= FEWEST_PAIRS && share < MOST_EQUAL;
    shown.then(|| longest_by_chance(share, samples))
}

/// Pairs of equal neighbours.
fn equal_pairs(values: &[f64]) -> usize {
    values.windows(2).filter(|pair| pair[0] == pair[1]).count()
}

/// Stretches in which a sensor without noise would show one value: the angle at rest, the others at constant currents.
fn steady(logs: &Logs, run: usize, channel: Channel) -> Vec<Range<usize>> {
    let rest = logs.settled(run, Open::Neither);
    match channel {
        Channel::RockerAngle => rest,
        _ => {
            let open = [Open::Lift, Open::Lower].into_iter();
            let open = open.flat_map(|open| logs.settled(run, open));
            rest.into_iter().chain(open).collect()
        }
    }
}

fn equal_stretches(values: &[f64], time_s: &[f64], fewest: usize) -> Vec<Equal> {
    let known: Vec<usize> = (0..values.len())
        .filter(|&at| values[at].is_finite())
        .collect();
    let pairs = known.len().saturating_sub(1);
    let same = |at: usize| values[known[at]] == values[known[at + 1]];
    let of = |stretch: Range<usize>| Equal {
        run: 0,
        value: values[known[stretch.start]],
        count: stretch.len() + 1,
        from_s: time_s[known[stretch.start]],
        to_s: time_s[known[stretch.end]],
    };
    let found = stretches(pairs, fewest - 1, same).into_iter();
    let padded = |stretch: &Range<usize>| {
        let at_end = stretch.start == 0 || stretch.end == pairs;
        at_end && time_s[known[stretch.end]] - time_s[known[stretch.start]] < PADDED_S
    };
    found.filter(|stretch| !padded(stretch)).map(of).collect()
}

/// Adds a stretch to the one of the same run and value.
fn join(found: &mut Vec<Equal>, new: Equal) {
    match found
        .iter_mut()
        .find(|old| old.run == new.run && old.value == new.value)
    {
        Some(old) => {
            old.count += new.count;
            old.to_s = new.to_s;
        }
        None => found.push(new),
    }
}

/// One finding for each extreme and for zero, of all its runs, and one for all other values.
fn report(logs: &Logs, channel: Channel, found: &[Equal], range: (f64, f64)) -> Vec<Finding> {
    let of_kind = |kind: Kind, is: &dyn Fn(f64) -> bool| {
        let equals: Vec<&Equal> = found.iter().filter(|equal| is(equal.value)).collect();
        (!equals.is_empty()).then(|| finding(logs, channel, kind, &equals))
    };
    let (lowest, highest) = range;
    let inner = |value: f64| value != lowest && value != highest;
    [
        of_kind(Kind::Saturated, &|value| value == highest),
        of_kind(Kind::Saturated, &|value| {
            value == lowest && lowest < highest
        }),
        of_kind(Kind::DeadBand, &|value| inner(value) && value == 0.0),
        of_kind(Kind::Held, &|value| inner(value) && value != 0.0),
    ]
    .into_iter()
    .flatten()
    .collect()
}

fn finding(logs: &Logs, channel: Channel, kind: Kind, equals: &[&Equal]) -> Finding {
    let count: usize = equals.iter().map(|equal| equal.count).sum();
    let (title, unit, value) = (channel.title(), channel.unit(), equals[0].value);
    let what = match kind {
        Kind::Held => "holds single values".to_owned(),
        _ => format!("is exactly {value} {unit}"),
    };
    let seen = format!(
        "The {title} {what} for {count} samples in long stretches, without the noise that it has elsewhere."
    );
    let cure = match kind {
        Kind::Saturated => "Use a sensor or converter with a wider range, or empty these cells.",
        Kind::DeadBand => "Switch off the dead band of the instrument, or empty these cells.",
        _ => "Find out why the instrument stops to update, and empty these cells.",
    };
    let evidence = Evidence::of(value, logs.step[channel.index()], channel);
    let all = Finding::new(kind, evidence, seen, cure).of(channel.key());
    let first = equals[0];
    if equals.iter().any(|equal| equal.run != first.run) {
        return all;
    }
    all.in_run(logs.campaign, first.run)
        .between(first.from_s, equals[equals.len() - 1].to_s)
}
