//! Tunes gains, ramps and limits with CMA-ES over a set of moves, and of presses of the external button.
//!
//! Each candidate is driven on the model and on two neighbours. Their thresholds are shifted up and down by the
//! residual error of teaching, and they have typical hysteresis, friction, entrained air and cold-oil viscosity where
//! the model has none: gains that are tuned without hysteresis do not suit a real valve.

mod change;
mod cost;
mod evolution_strategy;
mod field;
pub mod figures;
mod knobs;
mod search;

use std::ops::ControlFlow;

use hitch_effects::find;
use hitch_plant::{AddedEffect, Model};
use hitch_quantities::{Calibration, ValidCalibration};

use figures::Figures;
use knobs::{Least, tuned_by, without};
use search::search;

use crate::closed_loop::{
    self, Course, Move, MoveResult, Press, PressResult, PressSummary, Summary, courses, run_presses,
};

pub use change::Change;
pub use cost::{cost, press_cost};
pub use field::FieldTrial;
pub use figures::Judged;
pub use knobs::KNOBS;

/// Residual error of a threshold after teaching, A.
const SPREAD_A: f64 = 0.02;
/// The effect behind `hydraulics.hysteresis`.
const HYSTERESIS: &str = "solenoid-hysteresis";
/// Typical width of the hysteresis of such valves, A.
const USUAL_HYSTERESIS_A: f64 = 0.12;
/// Effects of every machine, with typical values.
const USUAL: [(&str, &[f64]); 4] = [
    (HYSTERESIS, &[USUAL_HYSTERESIS_A]),
    ("coulomb-friction", &[400.0]),
    ("entrained-air", &[0.01, 1.2]),
    ("oil-viscosity", &[0.2, 0.042]),
];
/// Time for which a candidate is observed after a move, s; it covers all corrections that follow directly.
const AFTER_S: f64 = 1.5;

/// Plants with the moves and presses that are driven on them.
pub struct Trial {
    /// Lower bound for the hysteresis of the calibration. Dither hides hysteresis in these plants, so the search would
    /// reduce it for speed; on a real valve, which closes later, the hitch would then overshoot.
    least: Least,
    plants: Vec<(Model, Vec<Course>)>,
    presses: Vec<Press>,
    /// The values that the moves and presses can tune.
    knobs: Vec<&'static str>,
}

impl Trial {
    /// Prepares `moves` and `presses` on `model` and its neighbours.
    #[must_use]
    pub fn new(model: &Model, moves: &[Move], presses: &[Press]) -> Self {
        let plants = [
            model.clone(),
            neighbour(model, SPREAD_A),
            neighbour(model, -SPREAD_A),
        ]
        .map(|plant| {
            let courses = courses(&plant, moves);
            (plant, courses)
        });
        let own = model
            .effects
            .iter()
            .find(|added| added.effect.id() == HYSTERESIS);
        let own_a = own.and_then(|added| added.values.first().copied());
        Self {
            least: Least {
                knob: "hydraulics.hysteresis",
                value: own_a.unwrap_or(USUAL_HYSTERESIS_A),
            },
            plants: plants.into(),
            presses: presses.to_vec(),
            knobs: tuned_by(!moves.is_empty(), !presses.is_empty()),
        }
    }

    /// Drives all moves and presses; `None` if there are none.
    #[must_use]
    pub fn judge(&self, calibration: &ValidCalibration) -> Option<Judged> {
        let results: Vec<MoveResult> = self
            .plants
            .iter()
            .flat_map(|(plant, courses)| closed_loop::figures(plant, calibration, courses, AFTER_S))
            .collect();
        let pressed: Vec<PressResult> = self
            .plants
            .iter()
            .filter_map(|(plant, _)| run_presses(plant, calibration, &self.presses))
            .flat_map(|run| run.results)
            .collect();
        let (summary, presses) = (Summary::of(&results), PressSummary::of(&pressed));
        (summary.is_some() || presses.is_some()).then(|| Judged {
            calibration: calibration.clone(),
            named: figures::named(summary.as_ref(), presses.as_ref()),
            figures: Figures {
                cost: cost(&results) + press_cost(&pressed),
                summary,
                presses,
            },
        })
    }

    /// Searches from `base` with at most `trials` candidates. Values named in `fixed` (as in `position.creep_speed`) are
    /// not changed. `tell` is called after each candidate with their number so far and the best cost; the search ends with its
    /// best so far when it answers `Break`.
    #[must_use]
    pub fn search(
        &self,
        base: &Calibration,
        fixed: &[String],
        trials: usize,
        tell: impl Fn(usize, f64) -> ControlFlow<()> + Sync,
    ) -> Option<Judged> {
        let knobs = without(&self.knobs, fixed);
        search(base, &knobs, Some(self.least), trials, tell, |candidate| {
            self.judge(candidate)
        })
    }

    /// The values that are tuned, before and after.
    #[must_use]
    pub fn changes(&self, before: &Calibration, after: &Calibration) -> Vec<Change> {
        knobs::changes(&self.knobs, before, after)
    }
}

/// The model with both thresholds shifted, and with the typical effects that it lacks.
fn neighbour(model: &Model, shift_a: f64) -> Model {
    let mut effects = model.effects.clone();
    for id in ["lift-threshold-shift", "lower-threshold-shift"] {
        match effects.iter_mut().find(|added| added.effect.id() == id) {
            Some(added) => added.values.iter_mut().for_each(|value| *value += shift_a),
            None => effects.extend(added(id, &[shift_a])),
        }
    }
    for (id, values) in USUAL {
        if !effects.iter().any(|added| added.effect.id() == id) {
            effects.extend(added(id, values));
        }
    }
    model.clone().with_effects(effects)
}

fn added(id: &str, values: &[f64]) -> Option<AddedEffect> {
    Some(AddedEffect {
        effect: find(id)?,
        values: values.to_vec(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The method completes its generations, of a dozen candidates; no more of them than asked for are tried.
    #[test]
    fn a_search_tries_no_more_candidates_than_asked_for() {
        let trial = Trial {
            plants: Vec::new(),
            presses: Vec::new(),
            knobs: tuned_by(true, true),
            least: Least {
                knob: "hydraulics.hysteresis",
                value: USUAL_HYSTERESIS_A,
            },
        };
        for trials in [1, 10, 31] {
            let tried = std::sync::Mutex::new(Vec::new());
            let tell = |count, _| {
                tried.lock().expect("not poisoned").push(count);
                ControlFlow::Continue(())
            };
            let found = trial.search(&Calibration::nominal(), &[], trials, tell);
            assert!(found.is_none(), "nothing is driven");
            let tried = tried.into_inner().expect("not poisoned");
            assert_eq!(tried.iter().max(), Some(&trials));
        }
    }
}
