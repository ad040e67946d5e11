//! Splits a log into runs: where its clock jumps, and a long one where the hitch is at rest. Each starts at rest.

use hitch_campaign::{Bench, ClockStep, Run};
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
/// Minimum length of a log that is split at rests, s.
const LONG_LOG_S: f64 = 60.0;

/// The runs of a log.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Cuts {
    /// Their times after the log's first sample, s; empty for a single run.
    pub runs: Vec<(f64, f64)>,
    /// Why the log was split, or begins later; one line each.
    pub notes: Vec<String>,
    /// Whether no part of the log begins at rest and moves.
    pub is_useless: bool,
}

/// The runs of a log with these steps of its clock.
#[must_use]
pub fn cuts(run: &Run, steps: &[ClockStep]) -> Cuts {
    let first_s = run.time_s.first().copied().unwrap_or_default();
    let after_s = |sample: usize| run.time_s[sample] - first_s;
    let mut cuts = Cuts::default();
    let split = |step: &ClockStep| format!("{}: the run is split there", step.said);
    cuts.notes.extend(steps.iter().map(split));
    let mut begin = 0;
    for end in steps
        .iter()
        .map(|step| step.sample)
        .chain([run.time_s.len()])
    {
        // A flow bench has nothing that moves.
        let is_hitch = matches!(run.bench, Bench::Hitch { .. });
        let rest = if is_hitch && begins_in_motion(run, begin, end) {
            next_rest(run, begin, end)
        } else {
            Some(begin)
        };
        let moves = rest.map(|rest| moves(run, rest, end)).unwrap_or_default();
        let (from_s, to_s) = (after_s(begin), after_s(end - 1));
        match rest {
            Some(rest) if !moves.is_empty() || (steps.is_empty() && rest == begin) => {
                let rest_s = after_s(rest);
                if rest > begin {
                    cuts.notes.push(format!(
                        "it is in motion at {from_s:.2} s: the run begins at the next rest, at {rest_s:.2} s"
                    ));
                }
                if to_s - rest_s >= LONG_LOG_S && !moves.is_empty() {
                    cuts.runs.extend(between_rests(run, &moves, (rest_s, to_s)));
                } else {
                    cuts.runs.push((rest_s, to_s));
                }
            }
            _ => cuts.notes.push(format!(
                "no motion begins at rest from {from_s:.2} s to {to_s:.2} s: this part is left out"
            )),
        }
        begin = end;
    }
    cuts.is_useless = cuts.runs.is_empty();
    if let [(from_s, to_s)] = cuts.runs[..]
        && from_s == 0.0
        && to_s == run.duration_s()
    {
        cuts.runs.clear();
    }
    cuts
}

/// The runs between the rests of a part of a log, with its moves.
fn between_rests(run: &Run, moves: &[(usize, usize)], part: (f64, f64)) -> Vec<(f64, f64)> {
    let first_s = run.time_s.first().copied().unwrap_or_default();
    let mut runs: Vec<(f64, f64)> = Vec::new();
    for &(from, to) in moves {
        let from_s = (run.time_s[from] - first_s - OF_REST_S).max(part.0);
        let to_s = (run.time_s[to] - first_s + OF_REST_S).min(part.1);
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

/// Whether a part begins with an open valve, or moves before one is opened.
fn begins_in_motion(run: &Run, begin: usize, end: usize) -> bool {
    let until_s = run.time_s[begin] + CALM_S;
    let mut opened = (begin..end).filter(|&sample| !is_closed(run, sample));
    let opened = opened.next().unwrap_or(end);
    let calm = (begin..opened).take_while(|&sample| run.time_s[sample] <= until_s);
    opened == begin || calm.last().is_some_and(|last| !is_calm(run, begin, last))
}

/// The first sample of the next rest of a part.
fn next_rest(run: &Run, begin: usize, end: usize) -> Option<usize> {
    let mut rest = begin;
    for sample in begin..end {
        let is_later = run.time_s[sample] - run.time_s[begin] >= CALM_S;
        match is_closed(run, sample) && is_calm(run, rest, sample) {
            true if is_later && run.time_s[sample] - run.time_s[rest] >= CALM_S => {
                return Some(rest);
            }
            true => {}
            false => rest = sample + 1,
        }
    }
    None
}

/// First and last sample of each section between two rests.
fn moves(run: &Run, begin: usize, end: usize) -> Vec<(usize, usize)> {
    let mut moves: Vec<(usize, usize)> = Vec::new();
    for sample in (begin..end).filter(|&sample| !rests(run, begin, sample)) {
        match moves.last_mut() {
            Some((_, to)) if run.time_s[sample] - run.time_s[*to] < SHORTEST_REST_S => *to = sample,
            _ => moves.push((sample, sample)),
        }
    }
    moves
}

/// Whether both valves are closed and the hitch does not move, in a part that begins with sample `begin`.
fn rests(run: &Run, begin: usize, sample: usize) -> bool {
    let from_s = run.time_s[sample] - CALM_S;
    let before = run.time_s[begin..sample].partition_point(|time_s| *time_s < from_s);
    is_closed(run, sample) && is_calm(run, begin + before, sample)
}

/// Whether both valves are closed.
fn is_closed(run: &Run, sample: usize) -> bool {
    let [lift_a, lower_a] = [run.lift_current_a[sample], run.lower_current_a[sample]];
    lift_a.abs().max(lower_a.abs()) < RESTS_BELOW_A
}

/// Whether angle and pressure are the same at two samples.
fn is_calm(run: &Run, before: usize, sample: usize) -> bool {
    let calm = |channel, within| {
        let change = |values: &[f64]| (values[sample] - values[before]).abs();
        // A quantity that was not measured cannot show motion.
        let change = run.channel(channel).map(change);
        change.is_none_or(|change| change.is_nan() || change < within)
    };
    calm(Channel::RockerAngle, CALM_DEG) && calm(Channel::CylinderPressure, CALM_BAR)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A lift from 4 s to 6 s in a log of 10 s at 50 Hz, from `from_s` on, whose clock then jumps by `jump_s` at 8 s.
    fn lift(from_s: f64, jump_s: f64) -> Run {
        let times_s: Vec<f64> = (0..500).map(|i| 0.02 * f64::from(i)).collect();
        let kept = || times_s.iter().copied().filter(|time_s| *time_s >= from_s);
        let is_open = |time_s: f64| (4.0..6.0).contains(&time_s);
        let later_s = |time_s: f64| if time_s >= 8.0 { jump_s } else { 0.0 };
        let mut channels = [const { None }; 4];
        let angle = |time_s: f64| 50.0 + 20.0 * (time_s.clamp(4.0, 6.0) - 4.0);
        channels[Channel::RockerAngle.index()] = Some(kept().map(angle).collect());
        Run {
            file: "a.csv".to_owned(),
            bench: Bench::Hitch { load_kg: 50.0 },
            oil_temperature_c: 40.0,
            oil_temperature_known: false,
            time_s: kept().map(|time_s| time_s + later_s(time_s)).collect(),
            lift_current_a: kept()
                .map(|time_s| if is_open(time_s) { 1.5 } else { 0.0 })
                .collect(),
            lower_current_a: kept().map(|_| 0.0).collect(),
            channels,
            oil_temperature_log_c: None,
        }
    }

    #[test]
    fn a_run_begins_at_rest() {
        assert_eq!(cuts(&lift(0.0, 0.0), &[]), Cuts::default());
        let cut = cuts(&lift(5.0, 0.0), &[]);
        assert!(
            cut.is_useless && cut.notes[0].contains("no motion begins at rest from 0.00 s"),
            "{cut:?}"
        );
        let mut again = lift(5.0, 0.0);
        again.lift_current_a[200..230].fill(1.5);
        let cut = cuts(&again, &[]);
        // The valve closes at 6 s, which is 1 s after the begin.
        assert_eq!(cut.runs.len(), 1, "{cut:?}");
        assert!((cut.runs[0].0 - 1.0).abs() < 0.03, "{cut:?}");
    }

    #[test]
    fn a_run_ends_where_the_clock_jumps() {
        let step = ClockStep {
            sample: 400,
            said: "line 402: its clock jumps".to_owned(),
        };
        let cut = cuts(&lift(0.0, 0.5), &[step]);
        assert_eq!(cut.runs.len(), 1, "the hitch rests behind it: {cut:?}");
        assert!((cut.runs[0].1 - 7.98).abs() < 1e-6, "{cut:?}");
        assert!(cut.notes[0].contains("line 402"), "{cut:?}");
    }
}
