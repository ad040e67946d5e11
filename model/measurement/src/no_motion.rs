//! Runs whose angle stays while the currents move the hitch in another run.

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
    samples: f64,
    travel_deg: f64,
}

/// The runs without motion.
pub(crate) fn findings(logs: &Logs) -> Vec<Finding> {
    let angle = |run: usize| logs.runs()[run].channel(Channel::RockerAngle);
    let hitches = logs.hitches();
    let lifts = hitches.flat_map(|(run, log, load_kg)| {
        let settled = angle(run).map(|_| logs.settled(run, Open::Lift));
        settled.into_iter().flatten().map(move |stretch| Lift {
            run,
            load_kg,
            current_a: median(currents(log)[0][stretch.clone()].iter().copied()),
            samples: stretch.len() as f64,
            travel_deg: angle(run).map_or(0.0, |angle| change(&angle[stretch])),
        })
    });
    let lifts: Vec<Lift> = lifts.collect();
    let runs = 0..logs.runs().len();
    let tops = runs.clone().filter_map(|run| Some(extremes(angle(run)?).1));
    let top_deg = tops.fold(f64::NEG_INFINITY, f64::max);
    let far_deg = 2.0 * FAR * logs.noise_of(Channel::RockerAngle);
    let still = |run: usize| {
        let (low, high) = extremes(angle(run)?);
        let stays = high - low < far_deg && high < top_deg - CERTAIN_DEG;
        let of_run = lifts.iter().filter(|lift| lift.run == run);
        let missed = of_run.flat_map(|lift| lifts.iter().map(|other| missed(lift, other)));
        let (missed_deg, other) = missed.max_by(|a, b| a.0.total_cmp(&b.0))?;
        let seen = format!(
            "The rocker angle stays within {:.2} deg; the same lift current moves it by {missed_deg:.0} deg or more in {}.",
            high - low,
            logs.runs()[other].file
        );
        let cure = "Check the angle sensor, its cable, and whether the valve was connected; leave the run out.";
        let evidence = Evidence::new(high - low, far_deg, "deg");
        let finding = Finding::new(Kind::NoMotion, evidence, seen, cure);
        let finding = finding.in_run(logs.campaign, run);
        (stays && missed_deg > CERTAIN_DEG).then(|| finding.of(Channel::RockerAngle.key()))
    };
    runs.filter_map(still).collect()
}

/// Travel, degrees, that a lift with as much load and no more current lets expect, and its run; zero of another lift.
fn missed(lift: &Lift, other: &Lift) -> (f64, usize) {
    let is_comparable = other.load_kg >= lift.load_kg && other.current_a <= lift.current_a + 0.01;
    let travel_deg = if is_comparable { other.travel_deg } else { 0.0 };
    (
        travel_deg * (lift.samples / other.samples).min(1.0),
        other.run,
    )
}
