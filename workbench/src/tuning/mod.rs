//! Searches gains, ramps and limits for the bars of motion: CMA-ES over a set of moves.
//!
//! What a model says nothing of is there all the same: each candidate is driven on the model itself and on two
//! neighbours whose thresholds are shifted up and down by what teaching leaves, and which have the hysteresis,
//! friction, air and thick oil of valves and cylinders of this class where the model has none. Gains for a valve
//! without hysteresis are useless on any other.

mod cost;
mod knobs;

use cmaes::{CMAESOptions, DVector};
use hitch_effects::find;
use hitch_plant::{AddedEffect, Model};
use hitch_quantities::{Calibration, ValidCalibration};
use knobs::{Least, with_values, without};

use crate::closed_loop::{Course, Move, MoveResult, Summary, courses, figures};

pub use cost::cost;
pub use knobs::KNOBS;

/// What teaching leaves of a threshold's error, A.
const SPREAD_A: f64 = 0.02;
/// The effect that `hydraulics.hysteresis` is about.
const HYSTERESIS: &str = "solenoid-hysteresis";
/// Width of it on valves of this class, A.
const USUAL_HYSTERESIS_A: f64 = 0.12;
/// Effects that every machine has, with usual values.
const USUAL: [(&str, &[f64]); 4] = [
    (HYSTERESIS, &[USUAL_HYSTERESIS_A]),
    ("coulomb-friction", &[400.0]),
    ("entrained-air", &[0.01, 1.2]),
    ("oil-viscosity", &[0.2, 0.042]),
];
/// How long a candidate is watched after a move, s: long enough for every correction that follows at once.
const AFTER_S: f64 = 1.5;
/// Where the search starts, in halvings and doublings of each value: 0.3 is a fifth up or down.
const START_SIGMA: f64 = 0.3;

/// Plants with the moves that are driven on them.
pub struct Trial {
    /// The hysteresis that valves have is believed at least: dither hides it in these plants, where the search would
    /// give it away for speed, and a hitch whose valves close later than that goes beyond its set point.
    least: Least,
    plants: Vec<(Model, Vec<Course>)>,
}

/// A calibration and what it does.
#[derive(Debug, Clone)]
pub struct Judged {
    /// The calibration.
    pub calibration: ValidCalibration,
    /// Figures of all moves on all plants.
    pub summary: Summary,
    /// What the search makes small.
    pub cost: f64,
}

/// One value that was searched.
#[derive(Debug, Clone, PartialEq)]
pub struct Change {
    /// `group.key`
    pub key: String,
    /// Before, engineering units.
    pub before: f64,
    /// After, engineering units.
    pub after: f64,
}

impl Trial {
    /// Prepares `moves` on `model` and its neighbours.
    #[must_use]
    pub fn new(model: &Model, moves: &[Move]) -> Self {
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
        }
    }

    /// Drives everything.
    #[must_use]
    pub fn judge(&self, calibration: &ValidCalibration) -> Option<Judged> {
        let results: Vec<MoveResult> = self
            .plants
            .iter()
            .flat_map(|(plant, courses)| figures(plant, calibration, courses, AFTER_S))
            .collect();
        Some(Judged {
            calibration: calibration.clone(),
            summary: Summary::of(&results)?,
            cost: cost(&results),
        })
    }

    /// Searches from `base` with about `trials` candidates, leaving the values in `fixed` (as in
    /// `position.creep_speed`) as they are there; `tell` hears of each: how many so far, and the best cost.
    #[must_use]
    pub fn search(
        &self,
        base: &Calibration,
        fixed: &[String],
        trials: usize,
        tell: impl Fn(usize, f64) + Sync,
    ) -> Option<Judged> {
        let knobs = without(fixed);
        let state = std::sync::Mutex::new((0, None::<Judged>));
        let objective = |point: &DVector<f64>| {
            let judged = with_values(base, &knobs, self.least, point.as_slice())
                .and_then(|calibration| self.judge(&calibration));
            let cost = judged.as_ref().map_or(f64::MAX, |judged| judged.cost);
            // Nothing panics while the lock is held.
            if let Ok(mut state) = state.lock() {
                state.0 += 1;
                if state.1.as_ref().is_none_or(|best| cost < best.cost) {
                    state.1 = judged;
                }
                tell(state.0, state.1.as_ref().map_or(f64::MAX, |best| best.cost));
            }
            cost
        };
        // The start is a candidate as well, with the hysteresis that valves have: nothing worse is ever returned.
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
}

/// What a search changed.
#[must_use]
pub fn changes(before: &Calibration, after: &Calibration) -> Vec<Change> {
    knobs::changes(before, after)
}

/// The model with both thresholds shifted, and with the usual effects that it doesn't have.
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
