//! The search for the calibration with the smallest cost, by CMA-ES.

use std::ops::ControlFlow;
use std::sync::Mutex;

use cmaes::{CMAESOptions, DVector};

/// Initial standard deviation in octaves of each value: 0.3 is about 20 %.
const START_SIGMA: f64 = 0.3;

/// A candidate with a cost.
pub trait Costly {
    /// The objective of the search; a smaller one is better.
    fn cost(&self) -> f64;
}

/// The best of at most `trials` candidates. `judge` drives the candidate at a point, each coordinate in octaves of a value; `None` if
/// there is none. `tell` is called after each with their number so far and the best cost; the search ends when it answers `Break`.
pub fn search<J: Costly + Send>(
    dimensions: usize,
    trials: usize,
    tell: impl Fn(usize, f64) -> ControlFlow<()> + Sync,
    judge: impl Fn(&[f64]) -> Option<J> + Sync,
) -> Option<J> {
    let state = Mutex::new((0, None::<J>, false));
    // The method always completes a generation.
    let is_over = || state.lock().is_ok_and(|state| state.0 >= trials || state.2);
    let objective = |point: &DVector<f64>| {
        if is_over() {
            return f64::MAX;
        }
        let judged = judge(point.as_slice());
        let cost = judged.as_ref().map_or(f64::MAX, Costly::cost);
        // No code panics while it holds the lock.
        if let Ok(mut state) = state.lock() {
            state.0 += 1;
            if state.1.as_ref().is_none_or(|best| cost < best.cost()) {
                state.1 = judged;
            }
            let best = state.1.as_ref().map_or(f64::MAX, Costly::cost);
            state.2 = tell(state.0, best).is_break();
        }
        cost
    };
    // The start is a candidate too, so that the result is never worse than it.
    objective(&DVector::zeros(dimensions));
    let mut search = CMAESOptions::new(vec![0.0; dimensions], START_SIGMA)
        .max_function_evals(trials)
        .seed(1)
        .build(objective)
        .ok()?;
    search.run();
    drop(search);
    state.into_inner().ok()?.1
}
