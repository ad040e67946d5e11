//! `angle-sensor-lag`: the angle sensor or its filter shows the angle late.
//!
//! `tau y' + y = angle`, first order. Hall sensors lag by 2 to 10 ms; filtering in the logger adds up to some 0.2 s.

use super::{Effect, Parameter};
use crate::campaign::Channel;
use crate::plant::Reading;
use crate::plant::lag::Lag;
use crate::plant::sites::{RunConditions, SensorStage, Sites};

/// Lag of the rocker angle sensor.
#[derive(Debug)]
pub struct AngleSensorLag;

static PARAMETERS: [Parameter; 1] = [Parameter {
    name: "time_constant",
    unit: "s",
    key: "time_constant_s",
    meaning: "time constant of the sensor",
    null: 0.0,
    typical: 0.06,
    low: 0.0,
    high: 2.0,
}];

impl Effect for AngleSensorLag {
    fn id(&self) -> &'static str {
        "angle-sensor-lag"
    }

    fn title(&self) -> &'static str {
        "Lag of the rocker angle sensor"
    }

    fn equation(&self) -> &'static str {
        "tau y' + y = angle"
    }

    fn source(&self) -> &'static str {
        "first-order sensor or input filter; 2 to 10 ms for hall sensors, up to 0.2 s with filtering"
    }

    fn shows(&self) -> &'static str {
        "the angle trails its true course by speed times lag, in both directions; pressures and flow stay right"
    }

    fn parameters(&self) -> &'static [Parameter] {
        &PARAMETERS
    }

    fn channels(&self) -> &'static [Channel] {
        &[Channel::RockerAngle]
    }

    fn attach(&self, values: &[f64], _: RunConditions<'_>, sites: &mut Sites) {
        sites
            .sensors
            .push(Box::new(AngleLag(Lag::at_rest(values[0], 0.0), values[0])));
    }
}

/// The lag and its time constant, s.
#[derive(Debug)]
struct AngleLag(Lag, f64);

impl SensorStage for AngleLag {
    fn rest(&mut self, reading: &mut Reading) {
        self.0 = Lag::at_rest(self.1, reading.rocker_angle_deg);
    }

    fn advance(&mut self, reading: &mut Reading, dt_s: f64) {
        reading.rocker_angle_deg = self.0.advance(reading.rocker_angle_deg, dt_s);
    }
}
