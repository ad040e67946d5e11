//! Figures of the last move while it runs.

use hitch_quantities::{Outputs, State};
use schemars::JsonSchema;
use serde::Serialize;

use crate::closed_loop::{ARRIVED_DEG, Sample};

/// Change of the set point that begins a move, degree.
const CHANGE_DEG: f64 = 0.01;
/// Pause of the lever that ends a movement of it, s: further changes within it belong to the same move.
const PAUSE_S: f64 = 0.5;
/// Time without current after which the hitch is at rest, s: the load has stopped oscillating.
const REST_S: f64 = 0.3;

/// Figures of a move.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct MoveFigures {
    /// Angle at the start, degree.
    from_deg: f64,
    /// Set point, degree.
    to_deg: f64,
    /// Largest overshoot of the set point since its last change, degree.
    overshoot_deg: f64,
    /// Angle minus set point at rest, degree; `None` while the hitch moves.
    error_deg: Option<f64>,
    /// Time from the last change of the set point until the angle stays within half a degree of it, s; `None` if it is
    /// not there.
    arrived_s: Option<f64>,
}

/// Follows the moves of a hitch.
#[derive(Debug, Default)]
pub struct Moves {
    set_point_deg: Option<f64>,
    changed_s: f64,
    driven_s: f64,
    figures: Option<MoveFigures>,
}

impl Moves {
    /// Includes a sample.
    pub fn follow(&mut self, sample: &Sample) {
        if !follows_lever(&sample.outputs) {
            *self = Self::default();
            return;
        }
        let now_s = sample.time_s;
        let to_deg = f64::from(sample.outputs.target.0) * 1e-3;
        let before_deg = *self.set_point_deg.get_or_insert(sample.angle_deg);
        if (to_deg - before_deg).abs() >= CHANGE_DEG {
            let same = self
                .figures
                .filter(|_| now_s - self.changed_s < PAUSE_S)
                .map(|figures| figures.from_deg);
            self.figures = Some(MoveFigures {
                from_deg: same.unwrap_or(sample.angle_deg),
                to_deg,
                overshoot_deg: 0.0,
                error_deg: None,
                arrived_s: None,
            });
            (self.set_point_deg, self.changed_s) = (Some(to_deg), now_s);
            self.driven_s = now_s;
        }
        let outputs = &sample.outputs;
        if outputs.lift_current.0 > 0 || outputs.lower_current.0 > 0 {
            self.driven_s = now_s;
        }
        let Some(figures) = &mut self.figures else {
            return;
        };
        let error_deg = sample.angle_deg - figures.to_deg;
        let way = (figures.to_deg - figures.from_deg).signum();
        figures.overshoot_deg = figures.overshoot_deg.max(error_deg * way);
        figures.error_deg = (now_s - self.driven_s >= REST_S).then_some(error_deg);
        figures.arrived_s = if error_deg.abs() <= ARRIVED_DEG {
            figures.arrived_s.or(Some(now_s - self.changed_s))
        } else {
            None
        };
    }

    /// Figures of the last move; `None` before the first one, and when the hitch does not follow the lever.
    pub fn last(&self) -> Option<MoveFigures> {
        self.figures
    }
}

/// Whether the hitch is in position control.
fn follows_lever(outputs: &Outputs) -> bool {
    matches!(
        outputs.state,
        State::Holding | State::Lifting | State::Lowering | State::Settling | State::Stalled
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use hitch_quantities::Inputs;
    use hitch_quantities::units::{MilliAmp, MilliDegree};

    fn sample(ms: u32, angle_deg: f64, target_deg: i32, lift_ma: i32) -> Sample {
        Sample {
            time_s: f64::from(ms) * 1e-3,
            lever_deg: f64::from(target_deg),
            angle_deg,
            cylinder_pressure_bar: 0.0,
            pump_pressure_bar: 0.0,
            inputs: Inputs::default(),
            outputs: Outputs {
                state: State::Holding,
                target: MilliDegree(target_deg * 1000),
                lift_current: MilliAmp(lift_ma),
                ..Outputs::default()
            },
        }
    }

    #[test]
    fn a_lift_that_overshoots_is_at_rest_after_a_pause() {
        let mut moves = Moves::default();
        moves.follow(&sample(0, 80.0, 80, 0));
        assert_eq!(moves.last(), None);
        moves.follow(&sample(1, 80.0, 100, 1500));
        moves.follow(&sample(900, 99.6, 100, 1500));
        moves.follow(&sample(1000, 100.7, 100, 0));
        let moving = moves.last().unwrap();
        assert_eq!((moving.error_deg, moving.arrived_s), (None, None));
        moves.follow(&sample(1100, 100.2, 100, 0));
        moves.follow(&sample(1300, 100.2, 100, 0));
        let at_rest = moves.last().unwrap();
        assert!((at_rest.overshoot_deg - 0.7).abs() < 1e-9);
        assert!((at_rest.error_deg.unwrap() - 0.2).abs() < 1e-9);
        assert!((at_rest.arrived_s.unwrap() - 1.099).abs() < 1e-9);
    }
}
