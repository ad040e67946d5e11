//! Runs with exactly the samples of another one.

use hitch_campaign::Run;

use crate::finding::{Evidence, Finding, Kind};
use crate::logs::{Logs, currents};

/// The repeated runs. With noise on the channels, the samples of two measurements are never the same.
pub(crate) fn findings(logs: &Logs) -> Vec<Finding> {
    let runs = logs.runs();
    let repeated = (0..runs.len()).filter_map(|at| {
        let twin = (0..at).find(|&before| same(&runs[before], &runs[at]))?;
        let count = runs[at].time_s.len();
        let seen = format!("All {count} samples are those of {}.", runs[twin].file);
        let cure = "Remove one of the two runs from campaign.toml: it counts twice.";
        let evidence = Evidence::new(count as f64, 0.0, "samples");
        Some(Finding::new(Kind::RepeatedRun, evidence, seen, cure).in_run(logs.campaign, at))
    });
    repeated.collect()
}

fn same(a: &Run, b: &Run) -> bool {
    let series = |run| currents(run).map(Some).into_iter().chain(channels(run));
    let bits = |values: &[f64]| values.iter().map(|v| v.to_bits()).collect::<Vec<u64>>();
    let varied = channels(a).flatten().any(|c| c.iter().any(|v| *v != c[0]));
    varied
        && series(a)
            .map(|s| s.map(bits))
            .eq(series(b).map(|s| s.map(bits)))
}

fn channels(run: &Run) -> impl Iterator<Item = Option<&[f64]>> {
    run.channels.iter().map(Option::as_deref)
}
