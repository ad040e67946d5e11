//! The search for the calibration with the smallest cost, by CMA-ES.

use std::ops::ControlFlow;
use std::sync::Mutex;

use cmaes::{CMAESOptions, DVector};
use hitch_quantities::{Calibration, ValidCalibration};

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
    tell: impl Fn(usize, f64) -> ControlFlow<()> + Sync,
    judge: impl Fn(&ValidCalibration) -> Option<Judged> + Sync,
) -> Option<Judged> {
    let state = Mutex::new((0, None::<Judged>, false));
    let cost_of =
        |judged: &Option<Judged>| judged.as_ref().map_or(f64::MAX, |one| one.figures.cost);
    // The method always completes a generation.
    let is_over = || state.lock().is_ok_and(|state| state.0 >= trials || state.2);
    let objective = |point: &DVector<f64>| {
        if is_over() {
            return f64::MAX;
        }
        let candidate = with_values(base, knobs, least, point.as_slice());
        let judged = candidate.and_then(|candidate| judge(&candidate));
        let cost = cost_of(&judged);
        // No code panics while it holds the lock.
        if let Ok(mut state) = state.lock() {
            state.0 += 1;
            if state.1.is_none() || cost < cost_of(&state.1) {
                state.1 = judged;
            }
            state.2 = tell(state.0, cost_of(&state.1)).is_break();
        }
        cost
    };
    // The start is a candidate too, so that the result is never worse than it.
    objective(&DVector::zeros(knobs.len()));
    let mut search = CMAESOptions::new(vec![0.0; knobs.len()], START_SIGMA)
        .max_function_evals(trials)
        .seed(1)
        .build(objective)
        .ok()?;
    search.run();
    drop(search);
    state.into_inner().ok()?.1
}
