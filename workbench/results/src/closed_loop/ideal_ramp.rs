//! The reference for move times: the shortest manoeuvre of the plant with edges of 100 ms.
//!
//! The valve opens from its threshold to saturation in an edge of 100 ms, stays open, and closes with the same edge. (A
//! step would swing the pressure of a loaded cylinder by 18 to 40 bar.) The open time is determined so that the hitch
//! comes to rest at the set point; in a short move the valve does not open fully. The manoeuvre is open loop with
//! perfect knowledge of the plant: a controller can be faster only with steeper edges, at the cost of a larger pressure
//! swing. Its time ratio is then below one.

use hitch_closed_loop::{ARRIVED_DEG, STEP_S};
use hitch_plant::{Currents, HitchRig, Model, Plant, Rig};

use super::pressure_swing::swing_bar;
use super::scenario::Move;
use hitch_closed_loop::valve_survey::ValveEnds;

/// Edge of the ideal manoeuvre, s.
pub const EDGE_S: f64 = 0.1;
/// Time for which the hitch may oscillate after the coil is off, s.
const SWING_S: f64 = 1.0;
/// Longest manoeuvre that is simulated, s.
const LONGEST_S: f64 = 20.0;

/// Figures of the ideal manoeuvre for one move.
#[derive(Debug, Clone, PartialEq)]
pub struct IdealRamp {
    /// Time until the angle first comes within half a degree of the set point, s; NaN if it never does, for example
    /// because the relief valve opens. Later oscillation does not count: a gentler manoeuvre may settle sooner, but
    /// none with such edges arrives sooner.
    pub time_s: f64,
    /// Peak-to-peak cylinder pressure, bar; NaN if it never arrives.
    pub pressure_swing_bar: f64,
    /// Angle in each step until arrival, degree; of the whole simulation if it never arrives.
    pub angles_deg: Vec<f64>,
}

impl IdealRamp {
    /// The ideal manoeuvre for `order`; `ends` are threshold and saturation of the valve that is used.
    #[must_use]
    pub fn find(model: &Model, order: &Move, ends: ValveEnds) -> Self {
        let drive = |on_s: f64| {
            Drive {
                model,
                order,
                ends,
                on_s,
            }
            .run()
        };
        let (mut short_s, mut long_s) = (0.0, LONGEST_S);
        // 20 s bisected 15 times is below a millisecond.
        for _ in 0..15 {
            let middle_s = 0.5 * (short_s + long_s);
            if drive(middle_s).is_short_of(order) {
                short_s = middle_s;
            } else {
                long_s = middle_s;
            }
        }
        drive(long_s).figures(order)
    }
}

/// One manoeuvre with the valve on for `on_s`.
struct Drive<'a> {
    model: &'a Model,
    order: &'a Move,
    ends: ValveEnds,
    on_s: f64,
}

/// Angle and cylinder pressure in each millisecond.
struct Track(Vec<(f64, f64)>);

impl Drive<'_> {
    fn run(&self) -> Track {
        let start_angle_rad = self.order.from_deg.to_radians();
        let rig = Rig::Hitch(HitchRig {
            load_kg: self.order.load_kg,
            start_angle_rad,
        });
        let mut plant = Plant::new(
            self.model,
            rig,
            self.order.oil_temperature_c,
            Currents::default(),
        );
        let upward = self.order.to_deg > self.order.from_deg;
        let mut track = Vec::new();
        let steps = ((self.on_s + SWING_S) / STEP_S) as usize;
        for step in 0..steps {
            let current_a = self.current_a(step as f64 * STEP_S);
            let currents = if upward {
                Currents {
                    lift_a: current_a,
                    lower_a: 0.0,
                }
            } else {
                Currents {
                    lift_a: 0.0,
                    lower_a: current_a,
                }
            };
            plant.step(currents, STEP_S);
            let angle_deg = plant.rocker_angle_rad().to_degrees();
            track.push((angle_deg, plant.reading().cylinder_pressure_bar));
            if is_past(self.order, angle_deg, 5.0) {
                break;
            }
        }
        Track(track)
    }

    fn current_a(&self, time_s: f64) -> f64 {
        let opening = (time_s / EDGE_S)
            .min((self.on_s - time_s) / EDGE_S)
            .min(1.0);
        if opening > 0.0 {
            self.ends.threshold_a + opening * (self.ends.saturation_a - self.ends.threshold_a)
        } else {
            0.0
        }
    }
}

impl Track {
    /// Whether the hitch stops short of the set point.
    fn is_short_of(&self, order: &Move) -> bool {
        self.0
            .last()
            .is_none_or(|&(angle_deg, _)| !is_past(order, angle_deg, 0.0))
    }

    fn figures(&self, order: &Move) -> IdealRamp {
        let near = |&(angle_deg, _): &(f64, f64)| (angle_deg - order.to_deg).abs() <= ARRIVED_DEG;
        let arrived = self.0.iter().position(near);
        let swing_bar = swing_bar(self.0.iter().map(|&(_, bar)| bar));
        let steps = arrived.unwrap_or(self.0.len());
        IdealRamp {
            time_s: arrived.map_or(f64::NAN, |at| (at + 1) as f64 * STEP_S),
            pressure_swing_bar: arrived.map_or(f64::NAN, |_| swing_bar),
            angles_deg: self.0.iter().take(steps).map(|&(deg, _)| deg).collect(),
        }
    }
}

/// Whether `angle_deg` is beyond the set point by more than `by_deg`.
fn is_past(order: &Move, angle_deg: f64, by_deg: f64) -> bool {
    let way = (order.to_deg - order.from_deg).signum();
    (angle_deg - order.to_deg) * way > by_deg
}
