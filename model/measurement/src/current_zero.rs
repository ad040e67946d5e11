//! Currents that do not read zero where both valves are shut.

use crate::finding::{Evidence, Finding, Kind, by_run};
use crate::logs::{CURRENTS, FAR, Logs, Open, SHUT_A};

/// The currents with an offset, in all runs or in single ones.
pub(crate) fn findings(logs: &Logs) -> Vec<Finding> {
    (0..2)
        .flat_map(|current| of_current(logs, current))
        .collect()
}

fn of_current(logs: &Logs, current: usize) -> Vec<Finding> {
    let sigma_a = logs.current_noise_a[current];
    let level_a = |run: usize| {
        let level_a = logs.level_a[run][current];
        let rests = !logs.settled(run, Open::Neither).is_empty();
        (rests && level_a < SHUT_A).then_some(level_a)
    };
    // Three sigma of a sample; the median of the dozens at rest has less than a fifth of it, so that a false alarm is beyond 15 sigma.
    let is_offset = |level_a: f64| level_a.abs() > 0.5 * FAR * sigma_a;
    by_run(logs.campaign, level_a, is_offset, |level_a| {
        let valve = ["lift", "lowering"][current];
        let seen = format!("The {valve} current reads {level_a:.3} A where both valves are shut.");
        let cure = "Subtract it from the log if the driver holds no standing current, and set the zero of the current probe.";
        let evidence = Evidence::new(level_a, sigma_a, "A");
        Finding::new(Kind::CurrentZero, evidence, seen, cure).of(CURRENTS[current])
    })
}
