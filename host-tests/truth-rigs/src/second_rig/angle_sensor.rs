//! The rocker's angle sensor: lag, backlash of its lever, gain and once-per-turn error.

use std::collections::VecDeque;

use super::linkage;
use super::physics::Sensors;

/// The rocker's angle sensor with its lever.
#[derive(Debug, Clone)]
pub struct AngleSensor<'a> {
    sensors: &'a Sensors,
    lever_m: f64,
    true_deg: f64,
    lagging_deg: f64,
    delayed_deg: VecDeque<f64>,
}

impl<'a> AngleSensor<'a> {
    /// A sensor at rest at a travel, m.
    #[must_use]
    pub fn new(sensors: &'a Sensors, travel_m: f64) -> Self {
        Self {
            sensors,
            lever_m: travel_m,
            true_deg: linkage::at(travel_m).rocker_deg,
            lagging_deg: linkage::at(travel_m).rocker_deg,
            delayed_deg: VecDeque::new(),
        }
    }

    /// Goes on by `dt_s`, at whose end the piston is at a travel, m.
    pub fn advance(&mut self, travel_m: f64, dt_s: f64) {
        let half_m = 0.5 * self.sensors.backlash_m;
        self.lever_m = self.lever_m.max(travel_m - half_m).min(travel_m + half_m);
        let mut angle_deg = linkage::at(self.lever_m).rocker_deg;
        let mut lag_s = self.sensors.angle_lag_s;
        if self.sensors.angle_delayed {
            lag_s *= 0.5;
            self.delayed_deg.push_back(angle_deg);
            angle_deg = if self.delayed_deg.len() as f64 * dt_s > lag_s {
                self.delayed_deg.pop_front().unwrap_or(angle_deg)
            } else {
                self.lagging_deg
            };
        }
        // The mean of the step: an input held at its end would be half a step early.
        let mean_deg = 0.5 * (self.true_deg + angle_deg);
        self.true_deg = angle_deg;
        if lag_s > 0.0 {
            self.lagging_deg -= (-dt_s / lag_s).exp_m1() * (mean_deg - self.lagging_deg);
        } else {
            self.lagging_deg = angle_deg;
        }
    }

    /// Its reading, degree.
    #[must_use]
    pub fn shown_deg(&self) -> f64 {
        self.shown_at_rest_deg(self.lagging_deg)
    }

    /// Its reading of a hitch that rests at an angle, degree.
    #[must_use]
    pub fn shown_at_rest_deg(&self, angle_deg: f64) -> f64 {
        let sensors = self.sensors;
        let (cam_deg, phase) = sensors.cam;
        angle_deg
            + sensors.angle_gain * (angle_deg - sensors.angle_pivot_deg)
            + cam_deg * ((4.0 * angle_deg).to_radians() + phase).sin()
    }
}
