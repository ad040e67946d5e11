//! `angle-sensor-gain`: gain error of the angle sensor.
//!
//! `y = (1 + g) angle`; typical values are 0.5 to 1 % of full scale for a hall sensor, more for a worn lever or a wrong
//! supply.

use hitch_plant::hooks::effect_hooks::{EffectHooks, RunConditions, SensorStage};
use hitch_plant::{Channel, Parameter, Reading};

use crate::described::Described;

/// Gain error of the rocker angle sensor.
pub static ANGLE_SENSOR_GAIN: Described = Described {
    id: "angle-sensor-gain",
    title: "Gain error of the rocker angle sensor",
    equation: "y = (1 + gain) angle",
    source: "hall angle sensors, +-0.5 to 1 % of full scale; a ratiometric sensor on a wrong supply \
         more",
    shows: "the angle changes too much or too little for the oil that flowed, lifting and lowering \
         alike; easily taken for a wrong stroke",
    parameters: &[Parameter {
        meaning: "relative error of the angle",
        typical: 0.02,
        low: -0.3,
        high: 0.3,
        ..Parameter::ratio("gain")
    }],
    channels: &[Channel::RockerAngle],
    attach,
    ..Described::USUAL
};

fn attach(values: &[f64], _: RunConditions<'_>, hooks: &mut EffectHooks) {
    hooks.sensors.push(Box::new(Gain { gain: values[0] }));
}

#[derive(Debug, Clone)]
struct Gain {
    gain: f64,
}

impl SensorStage for Gain {
    fn rest(&mut self, reading: &mut Reading) {
        reading.rocker_angle_deg *= 1.0 + self.gain;
    }

    fn advance(&mut self, reading: &mut Reading, _: f64) {
        self.rest(reading);
    }

    fn angle_behind_deg(&self, shown_deg: f64) -> f64 {
        shown_deg / (1.0 + self.gain)
    }
}
