//! The yardstick: the shortest manoeuvre that the plant allows between edges of 100 ms.
//!
//! The valve goes from its threshold to saturation in an edge of 100 ms, the shortest of a normal manoeuvre (a step
//! swings the pressure of a loaded cylinder by 18 to 40 bar), stays open, and closes with the same edge. How long it
//! stays on is found so that the hitch comes to rest on the set point; short moves don't open fully. It is driven
//! open loop with perfect knowledge: no controller can be much faster without harder edges. One that opens or closes
//! its valve more steeply than that can be a little faster, at the price of a larger pressure swing: then its time over
//! the shortest is below one.

use hitch_plant::{Currents, HitchRig, Model, Plant, Rig};

use super::loop_::STEP_S;
use super::metrics::{ARRIVED_DEG, swing_bar};
use super::scenario::Move;
use crate::valve_survey::ValveEnds;

/// Edge of the ideal manoeuvre, s.
pub const EDGE_S: f64 = 0.1;
/// How long the hitch may swing after the coil is off, s.
const SWING_S: f64 = 1.0;
/// Longest manoeuvre that is tried, s.
const LONGEST_S: f64 = 20.0;

/// Figures of the ideal manoeuvre for one move.
#[derive(Debug, Clone, PartialEq)]
pub struct IdealRamp {
    /// Until the angle first comes within half a degree of the set point, s; not a number if it never does, as where
    /// the relief valve forbids it. How the hitch swings afterwards is not counted: a gentler manoeuvre may rest
    /// sooner, but none between such edges arrives sooner.
    pub time_s: f64,
    /// Peak-to-peak cylinder pressure, bar; not a number if it never arrives.
    pub pressure_swing_bar: f64,
    /// Angle of each step until then, degree; of all that were tried if it never arrives.
    pub angles_deg: Vec<f64>,
}

impl IdealRamp {
    /// The ideal manoeuvre for `order`; `ends` are threshold and saturation of the valve that does it.
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
        // 20 s halved 15 times is below a millisecond.
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

/// Angle and cylinder pressure of each millisecond.
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
            let currents = match upward {
                true => Currents {
                    lift_a: current_a,
                    lower_a: 0.0,
                },
                false => Currents {
                    lift_a: 0.0,
                    lower_a: current_a,
                },
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
        match opening > 0.0 {
            true => {
                self.ends.threshold_a + opening * (self.ends.saturation_a - self.ends.threshold_a)
            }
            false => 0.0,
        }
    }
}

impl Track {
    /// True if the hitch ends short of the set point.
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

/// True if `angle_deg` is beyond the set point by more than `by_deg`.
fn is_past(order: &Move, angle_deg: f64, by_deg: f64) -> bool {
    let way = (order.to_deg - order.from_deg).signum();
    (angle_deg - order.to_deg) * way > by_deg
}
