//! `pin-backlash`: play between the piston and the rocker angle's sensor.
//!
//! Gravity keeps the loaded pins closed, so play only affects the angle measurement: the sensor follows the piston
//! through a play operator of full width b, `w = clamp(w_before, x - b/2, x + b/2)`, and shows the angle at w. Typical
//! widths are 0.5 to 2 mm.

use std::sync::Arc;

use hitch_plant::hooks::effect_hooks::{EffectHooks, RunConditions, SensorStage};
use hitch_plant::{Channel, Linkage, Parameter, Reading};

use crate::described::Described;

/// Backlash between piston and angle sensor.
pub static PIN_BACKLASH: Described = Described {
    id: "pin-backlash",
    title: "Backlash between piston and angle sensor",
    equation: "w = clamp(w_before, x - width/2, x + width/2); angle = angle(w)",
    source: "worn pins and sensor lever, 0.5 to 2 mm at the piston",
    shows: "the angle stays constant for the first millimetres after every reversal while oil flows; lifting \
         and lowering differ by a constant angle",
    parameters: &[Parameter {
        meaning: "full width of the play at the piston",
        typical: 1.0,
        low: 0.0,
        high: 20.0,
        ..Parameter::quantity("width", "mm", "width_mm")
    }],
    channels: &[Channel::RockerAngle],
    attach,
    ..Described::USUAL
};

fn attach(values: &[f64], conditions: RunConditions<'_>, hooks: &mut EffectHooks) {
    hooks.sensors.push(Box::new(Backlash {
        half_width_m: 0.5e-3 * values[0],
        follower_m: 0.0,
        linkage: Arc::clone(conditions.linkage),
    }));
}

#[derive(Debug, Clone)]
struct Backlash {
    half_width_m: f64,
    follower_m: f64,
    linkage: Arc<Linkage>,
}

impl Backlash {
    fn piston_m(&self, reading: &Reading) -> f64 {
        let angle_rad = reading.rocker_angle_deg.to_radians();
        self.linkage.piston_m(angle_rad)
    }
}

impl SensorStage for Backlash {
    fn rest(&mut self, reading: &mut Reading) {
        if reading.rocker_angle_deg.is_finite() {
            self.follower_m = self.piston_m(reading);
        }
    }

    fn advance(&mut self, reading: &mut Reading, _: f64) {
        if reading.rocker_angle_deg.is_finite() {
            let piston_m = self.piston_m(reading);
            self.follower_m = self
                .follower_m
                .max(piston_m - self.half_width_m)
                .min(piston_m + self.half_width_m);
            let follower = self.linkage.at(self.follower_m);
            // The linkage ends with the stroke, but the reading may exceed it: only the difference is taken from the
            // linkage.
            let there_rad = self.linkage.at(piston_m).rocker_angle_rad;
            reading.rocker_angle_deg += (follower.rocker_angle_rad - there_rad).to_degrees();
        }
    }
}
