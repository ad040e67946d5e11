//! Runs with exactly the samples of another one.

use hitch_campaign::Run;

use crate::finding::{Evidence, Finding, Kind};
use crate::logs::Logs;

/// The repeated runs. With noise on the channels, the samples of two measurements are never the same.
pub(crate) fn findings(logs: &Logs) -> Vec<Finding> {
    let runs = logs.runs();
    let twin = |at: usize| (0..at).find(|&before| same(&runs[before], &runs[at]));
    let finding = |(at, before): (usize, usize)| {
        let count = runs[at].time_s.len();
        let seen = format!("All {count} samples are those of {}.", runs[before].file);
        let cure = "Remove one of the two runs from campaign.toml: it counts twice.";
        let evidence = Evidence::new(count as f64, 0.0, "samples");
        Finding::new(Kind::RepeatedRun, evidence, seen, cure).in_run(logs.campaign, at)
    };
    (0..runs.len())
        .filter_map(|at| twin(at).map(|before| (at, before)))
        .map(finding)
        .collect()
}

fn same(a: &Run, b: &Run) -> bool {
    let equal = |a: &[f64], b: &[f64]| {
        a.len() == b.len()
            && a.iter()
                .zip(b)
                .all(|(a, b)| a == b || (a.is_nan() && b.is_nan()))
    };
    let channels = a.channels.iter().zip(&b.channels).all(|pair| match pair {
        (Some(a), Some(b)) => equal(a, b),
        (None, None) => true,
        _ => false,
    });
    let varied = |run: &Run| {
        run.channels
            .iter()
            .flatten()
            .any(|c| c.iter().any(|v| *v != c[0]))
    };
    channels
        && varied(a)
        && equal(&a.lift_current_a, &b.lift_current_a)
        && equal(&a.lower_current_a, &b.lower_current_a)
}
