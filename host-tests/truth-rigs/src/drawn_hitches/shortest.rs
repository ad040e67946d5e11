//! The shortest manoeuvre of a machine: the valve opens from its threshold to saturation in an edge, stays open, and
//! closes with the same edge, so that the hitch comes to rest at the set point. In short moves it does not open fully.

use super::draw::Drawn;
use crate::second_rig::data_sheet::{LIFT_TABLE, LOWER_TABLE};
use crate::second_rig::driven_hitch::DrivenHitch;

/// Edge of a normal manoeuvre, s.
const EDGE_S: f64 = 0.1;
/// How long the hitch may swing after the coil is off, s.
const SWING_S: f64 = 0.6;
/// Within this of the set point a move has arrived, degree.
pub const ARRIVED_DEG: f64 = 0.5;
/// Current at which both valves are fully open, A.
pub(super) const SATURATION_A: [f64; 2] = [3.252, 3.119];

/// Figures of the shortest manoeuvre.
#[derive(Debug, Clone, Copy)]
pub struct Shortest {
    /// Until the angle first comes within [`ARRIVED_DEG`], s.
    pub time_s: f64,
    /// Peak to peak of the cylinder pressure, bar.
    pub swing_bar: f64,
}

/// A manoeuvre: figures, and how far the hitch ends ahead of the set point, degree.
struct Tried {
    figures: Shortest,
    beyond_deg: f64,
}

impl Shortest {
    /// The shortest manoeuvre of `drawn` between two angles, degree.
    #[must_use]
    pub fn find(drawn: &Drawn, from_deg: f64, to_deg: f64) -> Self {
        let drive = |on_s: f64| drive(drawn, from_deg, to_deg, on_s);
        let way_deg = (to_deg - from_deg).abs();
        let (mut low, mut high) = ((0.0, -way_deg), (0.3, 0.0));
        let mut best = drive(high.0);
        high.1 = best.beyond_deg;
        while high.1 < 0.0 && high.0 < 30.0 {
            low = high;
            high.0 *= 1.6;
            best = drive(high.0);
            high.1 = best.beyond_deg;
        }
        // False position, kept off the ends: the way grows evenly with the time once the valve is open.
        for _ in 0..30 {
            if high.0 - low.0 < 1e-3 || high.1 < 0.02 {
                break;
            }
            let share = (-low.1 / (high.1 - low.1)).clamp(0.1, 0.9);
            let middle = low.0 + share * (high.0 - low.0);
            let tried = drive(middle);
            if tried.beyond_deg < 0.0 {
                low = (middle, tried.beyond_deg);
            } else {
                high = (middle, tried.beyond_deg);
                best = tried;
            }
        }
        best.figures
    }
}

/// Threshold and saturation of one valve as it is, A: hysteresis is overcome from below.
fn ends_a(drawn: &Drawn, coil: usize) -> (f64, f64) {
    let physics = &drawn.physics;
    let play_a: f64 = physics
        .plays
        .iter()
        .map(|play| play.share * play.half_width_a)
        .sum();
    let shift_a = [physics.lift_shift_a, physics.lower_shift_a][coil] + play_a;
    let threshold_a = [LIFT_TABLE.threshold_a, LOWER_TABLE.threshold_a][coil];
    (threshold_a + shift_a, SATURATION_A[coil] + shift_a)
}

fn drive(drawn: &Drawn, from_deg: f64, to_deg: f64, on_s: f64) -> Tried {
    let mut hitch = DrivenHitch::new(&drawn.physics, drawn.conditions, from_deg);
    let way = (to_deg - from_deg).signum();
    let coil = usize::from(way < 0.0);
    let (threshold_a, saturation_a) = ends_a(drawn, coil);
    let beyond = |hitch: &DrivenHitch| (hitch.rocker_deg() - to_deg) * way;
    let (mut low_bar, mut high_bar) = (f64::INFINITY, f64::NEG_INFINITY);
    let mut arrived = None;
    let steps = ((on_s + SWING_S) * 1e3) as usize;
    for step in 0..steps {
        let time_s = step as f64 * 1e-3;
        let opening = (time_s / EDGE_S).min((on_s - time_s) / EDGE_S).min(1.0);
        let mut currents_a = [0.0; 2];
        if opening > 0.0 {
            currents_a[coil] = threshold_a + opening * (saturation_a - threshold_a);
        }
        hitch.step(currents_a);
        let bar = hitch.cylinder_bar();
        (low_bar, high_bar) = (low_bar.min(bar), high_bar.max(bar));
        if beyond(&hitch).abs() <= ARRIVED_DEG {
            arrived = arrived.or(Some(step + 1));
        }
        // Far beyond: its figures are not used.
        if beyond(&hitch) > 8.0 {
            break;
        }
    }
    Tried {
        figures: Shortest {
            time_s: arrived.unwrap_or(steps) as f64 * 1e-3,
            swing_bar: high_bar - low_bar,
        },
        beyond_deg: beyond(&hitch),
    }
}
