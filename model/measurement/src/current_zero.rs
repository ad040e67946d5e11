//! Currents that do not read zero where both valves are shut.

use hitch_campaign::Bench;

use crate::finding::{Evidence, Finding, Kind, common_or_single};
use crate::logs::{CURRENTS, FAR, Logs, SHUT_A, currents};
use crate::statistics::stretches;

/// Shortest time at the lowest level that counts as rest, s: shorter ones are ramps.
const REST_S: f64 = 0.3;

/// The currents with an offset, in all runs or in single ones.
pub(crate) fn findings(logs: &Logs) -> Vec<Finding> {
    (0..2)
        .flat_map(|current| of_current(logs, current))
        .collect()
}

fn of_current(logs: &Logs, current: usize) -> Vec<Finding> {
    let resting = (0..logs.runs().len()).filter(|&run| rests(logs, run, current));
    let levels: Vec<(usize, f64)> = resting
        .map(|run| (run, logs.level_a[run][current]))
        .collect();
    let sigma_a = logs.current_noise_a[current];
    // Three sigma of a sample; the median of the dozens at rest has less than a fifth of it, so that a false alarm is beyond 15 sigma.
    let offset = levels
        .iter()
        .filter(|level| level.1.abs() > 0.5 * FAR * sigma_a);
    let offset: Vec<(usize, f64)> = offset.copied().collect();
    common_or_single(logs.campaign, &offset, levels.len(), |level_a| {
        let valve = ["lift", "lowering"][current];
        let seen = format!("The {valve} current reads {level_a:.3} A where both valves are shut.");
        let cure = "Subtract it from the log if the driver holds no standing current, and set the zero of the current probe.";
        let evidence = Evidence::new(level_a, sigma_a, "A");
        Finding::new(Kind::CurrentZero, evidence, seen, cure).of(CURRENTS[current])
    })
}

/// Whether a valve rests at the lowest level of its current. On a flow bench only the other valve does.
fn rests(logs: &Logs, run: usize, current: usize) -> bool {
    let level_a = logs.level_a[run];
    let flow_bench = matches!(logs.runs()[run].bench, Bench::Flow { .. });
    let near_a = FAR * logs.current_noise_a[current];
    let values = currents(&logs.runs()[run])[current];
    let shut = |at: usize| (values[at] - level_a[current]).abs() <= near_a;
    level_a[current] < SHUT_A
        && !(flow_bench && level_a[current] > level_a[1 - current] + near_a)
        && !stretches(values.len(), logs.samples(run, REST_S), shut).is_empty()
}
