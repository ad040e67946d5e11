//! The search for the calibration with the smallest cost, by CMA-ES.

use std::ops::ControlFlow;

use hitch_quantities::{Calibration, ValidCalibration};

use super::evolution_strategy::EvolutionStrategy;
use super::figures::Judged;
use super::knobs::{Least, with_values};

/// Initial standard deviation in octaves of each value: 0.3 is about 20 %.
const START_SIGMA: f64 = 0.3;

/// Searches from `base` with at most `trials` candidates, which differ from it in the values `knobs` (as in `position.creep_speed`), one of
/// them limited below by `least`. `judge` drives a candidate; `None` if it cannot be driven. `tell` is called after each with their number so
/// far and the best cost; the search ends with its best so far when it answers `Break`.
pub fn search(
    base: &Calibration,
    knobs: &[&str],
    least: Option<Least>,
    trials: usize,
    tell: impl Fn(usize, f64) -> ControlFlow<()>,
    judge: impl Fn(&ValidCalibration) -> Option<Judged>,
) -> Option<Judged> {
    let cost_of =
        |judged: &Option<Judged>| judged.as_ref().map_or(f64::MAX, |one| one.figures.cost);
    let (mut best, mut judged) = (None::<Judged>, 0);
    let mut cost = |point: &[f64]| {
        let candidate = with_values(base, knobs, least, point);
        let result = candidate.and_then(|candidate| judge(&candidate));
        let cost = cost_of(&result);
        if best.is_none() || cost < cost_of(&best) {
            best = result;
        }
        judged += 1;
        match tell(judged, cost_of(&best)) {
            ControlFlow::Continue(()) if judged < trials => ControlFlow::Continue(cost),
            _ => ControlFlow::Break(()),
        }
    };
    // The start is a candidate too, so that the result is never worse than it.
    let start = cost(&vec![0.0; knobs.len()]);
    if start.is_continue() {
        EvolutionStrategy::new(knobs.len(), START_SIGMA, 1).run(cost);
    }
    best
}
