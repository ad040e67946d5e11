//! Where the runs are in a long log: they begin and end where the hitch rests.

use hitch_campaign::Run;
use hitch_plant::Channel;

/// Currents below this open no valve, A.
const RESTS_BELOW_A: f64 = 0.3;
/// A hitch that turns by less within [`CALM_S`] rests, degrees.
const CALM_DEG: f64 = 0.5;
/// A pressure that changes by less within [`CALM_S`] is steady, bar.
const CALM_BAR: f64 = 5.0;
/// How long it is looked at, s.
const CALM_S: f64 = 0.5;
/// A rest that is shorter parts no runs, s.
const SHORTEST_REST_S: f64 = 4.0;
/// What of a rest belongs to the runs on either side, s.
const OF_REST_S: f64 = 1.5;
/// Runs are joined until they are as long, s.
const SHORTEST_RUN_S: f64 = 15.0;
/// A log that is shorter is one run, s.
const LONG_LOG_S: f64 = 60.0;

/// The times of the runs after the log's first sample, s; none if it is one run.
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

/// First and last sample of everything between two rests.
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

/// Whether both valves are closed, and nothing moves.
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
    // What was not measured shows no motion.
    let change = (values[sample] - values[before]).abs();
    change.is_nan() || change < within
}
