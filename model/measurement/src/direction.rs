//! Flow and angle whose sign contradicts the valve that is open.

use hitch_plant::Channel;

use crate::finding::{Evidence, Finding, Kind, by_run};
use crate::logs::{FAR, Logs, Open};
use crate::statistics::{change, median_of_several};

/// Least travel from which a direction is known, degrees: leakage at a valve's dead zone makes less.
const LEAST_TRAVEL_DEG: f64 = 5.0;
/// The valves, with the sign of flow and travel while they are open.
const VALVES: [(Open, f64); 2] = [(Open::Lift, 1.0), (Open::Lower, -1.0)];

/// The runs in which flow or angle have the wrong sign, or none if all have.
pub(crate) fn findings(logs: &Logs) -> Vec<Finding> {
    let flow = "Log the flow with its sign, positive into the cylinder, or leave it out.";
    let angle = "Swap the ends of the angle's calibration, or the names of the two currents.";
    let mut found = of(logs, Kind::FlowSign, Channel::Flow, flow_with_valve, flow);
    let with_valve = travel_with_valve;
    found.extend(of(
        logs,
        Kind::AngleSign,
        Channel::RockerAngle,
        with_valve,
        angle,
    ));
    found
}

/// Median of the flow in the direction of the open valve, l/min; the smaller one of both valves.
fn flow_with_valve(logs: &Logs, at: usize) -> Option<f64> {
    let values = logs.runs()[at].channel(Channel::Flow)?;
    let far = FAR * logs.noise_of(Channel::Flow);
    let of_valve = |(open, sign)| {
        let samples = logs.settled(at, open).into_iter().flatten();
        let flows = samples.map(|i| values[i] * sign);
        median_of_several(flows.filter(|lpm: &f64| lpm.abs() > far))
    };
    VALVES.into_iter().filter_map(of_valve).reduce(f64::min)
}

/// Travel in the direction of the open valves, degrees.
fn travel_with_valve(logs: &Logs, at: usize) -> Option<f64> {
    let values = logs.runs()[at].channel(Channel::RockerAngle)?;
    let of_valve = |(open, sign): (Open, f64)| {
        let settled = logs.settled(at, open).into_iter();
        sign * settled.map(|stretch| change(&values[stretch])).sum::<f64>()
    };
    let travel: f64 = VALVES.into_iter().map(of_valve).sum();
    let least = LEAST_TRAVEL_DEG.max(2.0 * FAR * logs.noise_of(Channel::RockerAngle));
    (travel.abs() > least).then_some(travel)
}

fn of(
    logs: &Logs,
    kind: Kind,
    channel: Channel,
    with_valve: fn(&Logs, usize) -> Option<f64>,
    cure: &str,
) -> Vec<Finding> {
    // A magnitude without a sign is right while the hitch is lifted.
    let lowers = |run| !logs.settled(run, Open::Lower).is_empty();
    let shown = |run| with_valve(logs, run).filter(|value| *value < 0.0 || lowers(run));
    by_run(
        logs.campaign,
        shown,
        |value| value < 0.0,
        |value| {
            let (title, unit) = (channel.title(), channel.unit());
            let seen = format!(
                "The {title} contradicts the open valve, by {:.1} {unit}.",
                -value
            );
            let evidence = Evidence::of(value, 3.0 * logs.noise_of(channel), channel);
            Finding::new(kind, evidence, seen, cure).of(channel.key())
        },
    )
}
