//! The samples in which the lift valve drives oil into the cylinder.

use hitch_plant::Channel;

use crate::logs::{FAR, Logs, Open};

/// Time over which the angle's rise is seen, s.
const RISE_S: f64 = 0.2;

/// The settled samples in which only the lift valve is open and the flow is positive; without a flow, the angle rises.
pub(crate) fn lifting(logs: &Logs, at: usize) -> Vec<usize> {
    let run = &logs.runs()[at];
    let samples = logs.settled(at, Open::Lift).into_iter().flatten();
    if let Some(flow) = run.channel(Channel::Flow) {
        let far = FAR * logs.noise_of(Channel::Flow);
        return samples.filter(|&i| flow[i] > far).collect();
    }
    let Some(angle) = run.channel(Channel::RockerAngle) else {
        return Vec::new();
    };
    let (far, behind) = (
        FAR * logs.noise_of(Channel::RockerAngle),
        logs.samples(at, RISE_S),
    );
    samples
        .filter(|&i| i >= behind && angle[i] - angle[i - behind] > far)
        .collect()
}
