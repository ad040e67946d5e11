//! Flow and angle whose sign contradicts the valve that is open.

use hitch_plant::Channel;

use crate::finding::{Evidence, Finding, Kind, common_or_single};
use crate::logs::{FAR, Logs, Open};
use crate::statistics::{change, median, quantile};

/// Fewest samples beyond noise from which a sign is known: a delay of the flow leaves fewer at a change.
const FEWEST: usize = 20;
/// Least travel from which a direction is known, degrees: leakage at a valve's dead zone makes less.
const LEAST_TRAVEL_DEG: f64 = 5.0;
/// The valves, with the sign of flow and travel while they are open.
const VALVES: [(Open, f64); 2] = [(Open::Lift, 1.0), (Open::Lower, -1.0)];

/// The runs in which the flow has the wrong sign, or none.
pub(crate) fn flow(logs: &Logs) -> Vec<Finding> {
    let cure = "Log the flow with its sign, positive into the cylinder, or leave it out.";
    report(logs, Kind::FlowSign, Channel::Flow, flow_with_valve, cure)
}

/// The runs in which the angle falls while only the lift valve is open, or rises while only the lowering valve is.
pub(crate) fn angle(logs: &Logs) -> Vec<Finding> {
    let cure = "Swap the ends of the angle's calibration, or the names of the two currents.";
    report(
        logs,
        Kind::AngleSign,
        Channel::RockerAngle,
        travel_with_valve,
        cure,
    )
}

/// Median of the flow in the direction of the open valve, l/min: negative if nine tenths of it are against one of them.
fn flow_with_valve(logs: &Logs, at: usize) -> Option<f64> {
    let values = logs.runs()[at].channel(Channel::Flow)?;
    let far = FAR * logs.noise_of(Channel::Flow);
    let of_valve = |(open, sign)| {
        let samples = logs.settled(at, open).into_iter().flatten();
        let flows = samples
            .map(|i| values[i] * sign)
            .filter(|v: &f64| v.abs() > far);
        let flows: Vec<f64> = flows.collect();
        let against = quantile(flows.iter().copied(), 0.9) < 0.0;
        let middle = median(flows.iter().copied());
        (flows.len() >= FEWEST).then_some(if against { middle } else { middle.abs() })
    };
    VALVES.into_iter().filter_map(of_valve).reduce(f64::min)
}

/// Travel in the direction of the open valve, degrees: negative if none follows its valve.
fn travel_with_valve(logs: &Logs, at: usize) -> Option<f64> {
    let values = logs.runs()[at].channel(Channel::RockerAngle)?;
    let least = LEAST_TRAVEL_DEG.max(2.0 * FAR * logs.noise_of(Channel::RockerAngle));
    let [lift, lower] = VALVES.map(|(open, sign)| {
        let settled = logs.settled(at, open).into_iter();
        sign * settled.map(|stretch| change(&values[stretch])).sum::<f64>()
    });
    let travel = if lift.max(lower) > least {
        lift.max(lower)
    } else {
        lift.min(lower)
    };
    (travel.abs() > least).then_some(travel)
}

/// One finding for all runs if all that lower the hitch are wrong, else one for each.
fn report(
    logs: &Logs,
    kind: Kind,
    channel: Channel,
    with_valve: fn(&Logs, usize) -> Option<f64>,
    cure: &str,
) -> Vec<Finding> {
    let runs = 0..logs.runs().len();
    let judged: Vec<(usize, f64)> = runs
        .filter_map(|run| Some((run, with_valve(logs, run)?)))
        .collect();
    let lowers = |run: usize| !logs.settled(run, Open::Lower).is_empty();
    let could_be = judged
        .iter()
        .filter(|(run, size)| *size < 0.0 || lowers(*run))
        .count();
    let wrong: Vec<(usize, f64)> = judged.into_iter().filter(|judged| judged.1 < 0.0).collect();
    let (title, unit) = (channel.title(), channel.unit());
    common_or_single(logs.campaign, &wrong, could_be, |size| {
        let seen = format!(
            "The {title} contradicts the open valve, by {:.1} {unit}.",
            -size
        );
        let evidence = Evidence::of(size, 3.0 * logs.noise_of(channel), channel);
        Finding::new(kind, evidence, seen, cure).of(channel.key())
    })
}
