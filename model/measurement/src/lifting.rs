//! The samples in which the lift valve drives oil into the cylinder.

use hitch_plant::Channel;

use crate::logs::{FAR, Logs, Open};

/// Time over which the angle's rise is seen, s.
const RISE_S: f64 = 0.2;

/// The settled samples in which only the lift valve is open and the flow is positive; without a flow, the angle rises.
pub(crate) fn lifting(logs: &Logs, at: usize) -> Vec<usize> {
    let run = &logs.runs()[at];
    let behind = logs.samples(at, RISE_S);
    let far = |channel| FAR * logs.noise_of(channel);
    let (flow, angle) = (
        run.channel(Channel::Flow),
        run.channel(Channel::RockerAngle),
    );
    let lifts = |i: usize| match (flow, angle) {
        (Some(flow), _) => flow[i] > far(Channel::Flow),
        (_, Some(angle)) if i >= behind => angle[i] - angle[i - behind] > far(Channel::RockerAngle),
        _ => false,
    };
    let samples = logs.settled(at, Open::Lift).into_iter().flatten();
    samples.filter(|&i| lifts(i)).collect()
}
