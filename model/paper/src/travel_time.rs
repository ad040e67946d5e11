//! Figure 12 computed with the model: travel time of the hitch over its full travel.
//!
//! The paper shows the figure as a plot without numbers. Its text says that the lifting time does not depend on the
//! load, and that the lowering time decreases with load and with current (section 4.3).

use hitch_plant::{Currents, HitchRig, Model, Plant, Rig, Valve};

use crate::tables::{FIGURE_12_LIFT_A, FIGURE_12_LOADS_KG, FIGURE_12_LOWER_A};

/// Oil temperature of the tests, degrees Celsius; not stated in the paper.
const OIL_TEMPERATURE_C: f64 = 40.0;
/// Time step of the evaluation, s.
const STEP_S: f64 = 0.01;
/// Distance from the end, m, at which the travel counts as complete: a sensor would not resolve the rest.
const END_WITHIN_M: f64 = 1e-4;
/// Time after which a hitch that has not arrived is given up, s.
const LONGEST_S: f64 = 300.0;

/// One panel of Figure 12.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    /// Currents, A.
    pub currents_a: [f64; 5],
    /// Loads, kg.
    pub loads_kg: [f64; 5],
    /// Travel time by current, then by load, s; `None` if the end is not reached.
    pub times_s: [[Option<f64>; 5]; 5],
}

impl Panel {
    /// Largest difference between loads at one current, relative to their mean; `None` if an end is not reached.
    pub fn spread_over_load(&self) -> Option<f64> {
        let spread = |row: &[Option<f64>; 5]| {
            let times: Option<Vec<f64>> = row.iter().copied().collect();
            times.map(|times| {
                let least = times.iter().copied().fold(f64::INFINITY, f64::min);
                let greatest = times.iter().copied().fold(0.0, f64::max);
                (greatest - least) * times.len() as f64 / times.iter().sum::<f64>()
            })
        };
        self.times_s
            .iter()
            .map(spread)
            .try_fold(0.0, |worst: f64, spread| Some(worst.max(spread?)))
    }

    /// Whether a heavier load takes less time at every current.
    pub fn falls_with_load(&self) -> bool {
        self.times_s.iter().all(|row| falls(row.iter().copied()))
    }

    /// Whether a higher current takes less time at every load.
    pub fn falls_with_current(&self) -> bool {
        (0..self.loads_kg.len()).all(|load| falls(self.times_s.iter().map(|row| row[load])))
    }
}

/// Figure 12A (lifting) or 12B (lowering) for a model.
pub fn panel(model: &Model, valve: Valve) -> Panel {
    let currents_a = match valve {
        Valve::Lift => FIGURE_12_LIFT_A,
        Valve::Lowering => FIGURE_12_LOWER_A,
    };
    let loads_kg = FIGURE_12_LOADS_KG;
    let times_s = currents_a
        .map(|current_a| loads_kg.map(|load_kg| travel_s(model, valve, current_a, load_kg)));
    Panel {
        currents_a,
        loads_kg,
        times_s,
    }
}

/// Travel time after switching a current on, s; `None` if the end is not reached.
pub fn travel_s(model: &Model, valve: Valve, current_a: f64, load_kg: f64) -> Option<f64> {
    let stroke_m = model.constants().cylinder.stroke_m;
    let (start_m, currents) = match valve {
        Valve::Lift => (
            0.0,
            Currents {
                lift_a: current_a,
                lower_a: 0.0,
            },
        ),
        Valve::Lowering => (
            stroke_m,
            Currents {
                lift_a: 0.0,
                lower_a: current_a,
            },
        ),
    };
    let start_angle_rad = model.linkage().at(start_m).rocker_angle_rad;
    let mut plant = Plant::new(
        model,
        Rig::Hitch(HitchRig {
            load_kg,
            start_angle_rad,
        }),
        OIL_TEMPERATURE_C,
        Currents::default(),
    );
    let to_go_m =
        |plant: &Plant<'_>| stroke_m - END_WITHIN_M - (plant.state().piston_m - start_m).abs();
    let mut before_m = to_go_m(&plant);
    // The current is switched on within a hundredth of the time step: the plant interprets currents as ramps.
    plant.step(currents, 0.01 * STEP_S);
    for step in 0..(LONGEST_S / STEP_S) as usize {
        let now_m = to_go_m(&plant);
        if now_m <= 0.0 {
            let share = if before_m > now_m {
                before_m / (before_m - now_m)
            } else {
                1.0
            };
            return Some((step as f64 - 1.0 + share) * STEP_S);
        }
        before_m = now_m;
        plant.step(currents, STEP_S);
    }
    None
}

fn falls(times: impl Iterator<Item = Option<f64>>) -> bool {
    let times: Vec<Option<f64>> = times.collect();
    times
        .windows(2)
        .all(|pair| matches!(pair, [Some(before), Some(after)] if after < before))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lifting_takes_the_volume_over_the_flow() {
        let volume_l = 0.25 * std::f64::consts::PI * 0.76 * 0.76 * 1.579;
        let expected_s = volume_l
            / crate::flow_table::flow_lpm(&hitch_model_file::nominal(), Valve::Lift, 1.8)
            * 60.0;
        let time_s = travel_s(&hitch_model_file::nominal(), Valve::Lift, 1.8, 150.0).unwrap();
        assert!(
            (time_s / expected_s - 1.0).abs() < 2e-3,
            "{time_s} s against {expected_s} s"
        );
    }

    #[test]
    fn a_current_below_the_threshold_never_arrives() {
        assert_eq!(
            travel_s(&hitch_model_file::nominal(), Valve::Lift, 1.0, 150.0),
            None
        );
    }
}
