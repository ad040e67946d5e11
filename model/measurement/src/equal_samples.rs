//! Channels whose samples are equal for longer than their noise allows: at an extreme they are saturated.

use std::ops::Range;

use hitch_plant::Channel;

use crate::finding::{Evidence, Finding, Kind};
use crate::logs::{Logs, Open, extremes};
use crate::statistics::{noise, stretches};

/// Largest step in sigma of the noise that is seen: neighbours are equal with a probability of 0.17, or 0.24 if half of the variance is slow.
const FINE: f64 = 0.6;
/// Equal samples that are not chance: 17 of them are expected once in ten thousand campaigns of a million samples. Twice as many, as noise
/// may be slower.
const FEWEST: usize = 34;
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
    let shown = Channel::ALL
        .into_iter()
        .filter(|channel| shows_noise(logs, *channel));
    shown
        .flat_map(|channel| of_channel(logs, channel))
        .collect()
}

/// Whether the steps of a channel are fine enough to show its noise: of the angle at rest, of the others at constant currents.
fn shows_noise(logs: &Logs, channel: Channel) -> bool {
    let open = match channel {
        Channel::RockerAngle => &[Open::Neither][..],
        _ => &[Open::Neither, Open::Lift, Open::Lower],
    };
    let runs = logs.runs().iter().enumerate();
    let steady = runs.filter_map(|(at, run)| Some((at, run.channel(channel)?)));
    let steady = steady.flat_map(|(at, values)| {
        let stretches = open.iter().flat_map(move |&open| logs.settled(at, open));
        stretches.map(move |stretch| &values[stretch])
    });
    logs.step[channel.index()] < FINE * noise(steady)
}

/// One finding for the extremes, one for zero, and one for all other values.
fn of_channel(logs: &Logs, channel: Channel) -> Vec<Finding> {
    let runs = logs.runs().iter().enumerate();
    let logged: Vec<(usize, &[f64])> = runs
        .filter_map(|(at, run)| Some((at, run.channel(channel)?)))
        .collect();
    let ranges = logged.iter().map(|(_, values)| extremes(values));
    let range = ranges.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
    let (lowest, highest) = range.unwrap_or_default();
    let kind = |equal: &Equal| match equal.value {
        value if value == lowest || value == highest => Kind::Saturated,
        0.0 => Kind::DeadBand,
        _ => Kind::Held,
    };
    let of_run = |&(at, values): &(usize, &[f64])| equal_stretches(logs, at, values);
    let equals: Vec<Equal> = logged.iter().flat_map(of_run).collect();
    let of_kind = |of: Kind| {
        let equals: Vec<&Equal> = equals.iter().filter(|equal| kind(equal) == of).collect();
        (!equals.is_empty()).then(|| finding(logs, channel, of, &equals))
    };
    let kinds = [Kind::Saturated, Kind::DeadBand, Kind::Held];
    kinds.into_iter().filter_map(of_kind).collect()
}

fn equal_stretches(logs: &Logs, run: usize, values: &[f64]) -> Vec<Equal> {
    let time_s = &logs.runs()[run].time_s;
    let known: Vec<usize> = (0..values.len())
        .filter(|&at| values[at].is_finite())
        .collect();
    let pairs = known.len().saturating_sub(1);
    let same = |at: usize| values[known[at]] == values[known[at + 1]];
    let of = |stretch: Range<usize>| {
        let (from_s, to_s) = (time_s[known[stretch.start]], time_s[known[stretch.end]]);
        let at_end = stretch.start == 0 || stretch.end == pairs;
        let is_padded = at_end && to_s - from_s < PADDED_S;
        (!is_padded).then(|| Equal {
            run,
            value: values[known[stretch.start]],
            count: stretch.len() + 1,
            from_s,
            to_s,
        })
    };
    stretches(pairs, FEWEST - 1, same)
        .into_iter()
        .filter_map(of)
        .collect()
}

fn finding(logs: &Logs, channel: Channel, kind: Kind, equals: &[&Equal]) -> Finding {
    let count: usize = equals.iter().map(|equal| equal.count).sum();
    let (title, unit, value) = (channel.title(), channel.unit(), equals[0].value);
    let (what, cure) = match kind {
        Kind::Held => (
            "values such as",
            "Find out why the instrument stops to update",
        ),
        Kind::DeadBand => ("exactly", "Switch off the dead band of the instrument"),
        _ => ("exactly", "Use a sensor or converter with a wider range"),
    };
    let seen = format!(
        "The {title} holds {what} {value} {unit} for {count} samples in long stretches, without the noise that it has elsewhere."
    );
    let cure = &format!("{cure}, or empty these cells.");
    let evidence = Evidence::of(value, logs.step[channel.index()], channel);
    let all = Finding::new(kind, evidence, seen, cure).of(channel.key());
    let (first, last) = (equals[0], equals[equals.len() - 1]);
    if first.run != last.run {
        return all;
    }
    all.in_run(logs.campaign, first.run)
        .between(first.from_s, last.to_s)
}
