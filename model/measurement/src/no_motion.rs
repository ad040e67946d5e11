//! Runs whose angle stays while the currents move the hitch in another run.

use std::ops::Range;

use hitch_plant::Channel;

use crate::finding::{Evidence, Finding, Kind};
use crate::logs::{FAR, Logs, Open, currents, extremes};
use crate::statistics::{change, median};

/// Travel, degrees, that is certainly missed, and the distance from the upper end of the stroke.
const CERTAIN_DEG: f64 = 5.0;

/// A stretch of lifting.
struct Lift {
    run: usize,
    load_kg: f64,
    current_a: f64,
    from_s: f64,
    to_s: f64,
    travel_deg: f64,
}

/// The runs without motion.
pub(crate) fn findings(logs: &Logs) -> Vec<Finding> {
    let lifts: Vec<Lift> = logs
        .hitches()
        .flat_map(|(run, _, load_kg)| lifts(logs, run, load_kg))
        .collect();
    let ranges = logs
        .hitches()
        .filter_map(|(run, log, _)| Some((run, extremes(log.channel(Channel::RockerAngle)?))));
    let ranges: Vec<(usize, (f64, f64))> = ranges.collect();
    let highest = ranges
        .iter()
        .map(|range| range.1.1)
        .fold(f64::NEG_INFINITY, f64::max);
    let far = 2.0 * FAR * logs.noise_of(Channel::RockerAngle);
    let still = ranges
        .iter()
        .filter(|(_, (low, high))| high - low < far && *high < highest - CERTAIN_DEG);
    let finding = |&(run, (low, high)): &(usize, (f64, f64))| {
        let missed = |lift: &Lift| {
            missed(lift, &lifts).map(|missed| (missed.0, missed.1, lift.from_s, lift.to_s))
        };
        let of_run = lifts
            .iter()
            .filter(|lift| lift.run == run)
            .filter_map(missed);
        let (expected, twin, from_s, to_s) = of_run.max_by(|a, b| a.0.total_cmp(&b.0))?;
        let other = &logs.runs()[twin].file;
        let seen = format!(
            "The rocker angle stays within {:.2} deg; the same lift current moves it by {expected:.0} deg or more in {other}.",
            high - low
        );
        let cure = "Check the angle sensor, its cable, and whether the valve was connected; leave the run out.";
        let evidence = Evidence::new(high - low, far, "deg");
        let finding = Finding::new(Kind::NoMotion, evidence, seen, cure).in_run(logs.campaign, run);
        Some(finding.of(Channel::RockerAngle.key()).between(from_s, to_s))
    };
    still.filter_map(finding).collect()
}

fn lifts(logs: &Logs, at: usize, load_kg: f64) -> Vec<Lift> {
    let run = &logs.runs()[at];
    let Some(angle) = run.channel(Channel::RockerAngle) else {
        return Vec::new();
    };
    let lift = |stretch: Range<usize>| Lift {
        run: at,
        load_kg,
        current_a: median(currents(run)[0][stretch.clone()].iter().copied()),
        from_s: run.time_s[stretch.start],
        to_s: run.time_s[stretch.end - 1],
        travel_deg: change(&angle[stretch]),
    };
    let settled = logs.settled(at, Open::Lift).into_iter();
    settled.map(lift).collect()
}

/// Travel, degrees, that a lift of another run with as much load and no more current lets expect, and that run.
fn missed(lift: &Lift, lifts: &[Lift]) -> Option<(f64, usize)> {
    let comparable = |other: &&Lift| {
        other.run != lift.run
            && other.load_kg >= lift.load_kg
            && other.current_a <= lift.current_a + 0.01
    };
    let expected = |other: &Lift| {
        let share = ((lift.to_s - lift.from_s) / (other.to_s - other.from_s)).min(1.0);
        (other.travel_deg * share, other.run)
    };
    let most = lifts
        .iter()
        .filter(comparable)
        .map(expected)
        .max_by(|a, b| a.0.total_cmp(&b.0));
    most.filter(|most| most.0 > CERTAIN_DEG)
}
