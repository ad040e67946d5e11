//! Splits a long log into runs, which start and end where the hitch is at rest.

use hitch_campaign::Run;
use hitch_plant::Channel;

/// Current below which no valve opens, A.
const RESTS_BELOW_A: f64 = 0.3;
/// Largest change of angle within [`CALM_S`] at rest, degrees.
const CALM_DEG: f64 = 0.5;
/// Largest change of pressure within [`CALM_S`] at rest, bar.
const CALM_BAR: f64 = 5.0;
/// Time window of these changes, s.
const CALM_S: f64 = 0.5;
/// Shortest rest between two runs, s.
const SHORTEST_REST_S: f64 = 4.0;
/// Part of a rest that is kept in the adjacent runs, s.
const OF_REST_S: f64 = 1.5;
/// Minimum length of a run, s; shorter ones are joined.
const SHORTEST_RUN_S: f64 = 15.0;
/// Minimum length of a log that is split, s.
const LONG_LOG_S: f64 = 60.0;

/// The times of the runs after the log's first sample, s; empty for a single run.
#[must_use]
pub fn cuts(run: &Run) -> Vec<(f64, f64)> {
    if run.duration_s() < LONG_LOG_S {
        return Vec::new();
    }
    let moves = moves(run);
    let first_s = run.time_s.first().copied().unwrap_or_default();
    let last_s = run.duration_s();
    let mut runs: Vec<(f64, f64)> = Vec::new();
    for (from, to) in moves {
        let from_s = (run.time_s[from] - first_s - OF_REST_S).max(0.0);
        let to_s = (run.time_s[to] - first_s + OF_REST_S).min(last_s);
        match runs.last_mut() {
            Some(last) if last.1 - last.0 < SHORTEST_RUN_S && from_s - last.1 < SHORTEST_RUN_S => {
                last.1 = to_s
            }
            _ => runs.push((from_s, to_s)),
        }
    }
    let rounded = |time_s: f64| (time_s * 100.0).round() / 100.0;
    runs.iter()
        .map(|(from_s, to_s)| (rounded(*from_s), rounded(*to_s)))
        .collect()
}

/// First and last sample of each section between two rests.
fn moves(run: &Run) -> Vec<(usize, usize)> {
    let mut moves: Vec<(usize, usize)> = Vec::new();
    for sample in (0..run.time_s.len()).filter(|&sample| !rests(run, sample)) {
        match moves.last_mut() {
            Some((_, to)) if run.time_s[sample] - run.time_s[*to] < SHORTEST_REST_S => *to = sample,
            _ => moves.push((sample, sample)),
        }
    }
    moves
}

/// Whether both valves are closed and the hitch does not move.
fn rests(run: &Run, sample: usize) -> bool {
    let is_closed = run.lift_current_a[sample]
        .abs()
        .max(run.lower_current_a[sample].abs())
        < RESTS_BELOW_A;
    let calm = |channel, within| {
        run.channel(channel)
            .is_none_or(|values| is_calm(run, values, sample, within))
    };
    is_closed && calm(Channel::RockerAngle, CALM_DEG) && calm(Channel::CylinderPressure, CALM_BAR)
}

fn is_calm(run: &Run, values: &[f64], sample: usize, within: f64) -> bool {
    let before =
        run.time_s[..sample].partition_point(|time_s| *time_s < run.time_s[sample] - CALM_S);
    // A quantity that was not measured cannot show motion.
    let change = (values[sample] - values[before]).abs();
    change.is_nan() || change < within
}
